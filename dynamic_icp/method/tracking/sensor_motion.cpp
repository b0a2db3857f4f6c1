// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/sensor_motion.hpp"

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::tracking {

Eigen::Vector3d SensorMotion::position(double time_s) const {
  return T_world_sensor.translation() + time_s * velocity_world;
}

Eigen::Vector3d SensorMotion::direction_world(const Eigen::Vector3d& direction, double time_s) const {
  if (time_s == 0.0) {
    return T_world_sensor.linear() * direction;
  }
  // The rotation to second order: during a sweep it is small.
  const Eigen::Vector3d angle = time_s * angular_velocity_sensor;
  const Eigen::Vector3d first = angle.cross(direction);
  return T_world_sensor.linear() * (direction + first + 0.5 * angle.cross(first)).normalized();
}

SensorMotion continued_motion(const Eigen::Isometry3d& T_world_earlier, const Eigen::Isometry3d& T_world_sensor,
                              double dt_s) {
  const Eigen::Isometry3d T_earlier_sensor = T_world_earlier.inverse() * T_world_sensor;
  return {T_world_sensor, (T_world_sensor.translation() - T_world_earlier.translation()) / dt_s,
          log_so3(T_earlier_sensor.linear()) / dt_s};
}

}  // namespace dynamic_icp::tracking
