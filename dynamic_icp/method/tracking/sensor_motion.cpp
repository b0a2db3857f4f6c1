// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/sensor_motion.hpp"

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::tracking {

Eigen::Vector3d SensorMotion::position(double time_s) const {
  return T_world_sensor.translation() + time_s * velocity_world;
}

Eigen::Isometry3d SensorMotion::pose(double time_s) const {
  Eigen::Isometry3d pose = T_world_sensor;
  pose.linear() *= exp_so3(time_s * angular_velocity_sensor);
  pose.translation() = position(time_s);
  return pose;
}

Eigen::Vector3d SensorMotion::direction_world(const Eigen::Vector3d& direction, double time_s) const {
  return time_s == 0.0 ? Eigen::Vector3d(T_world_sensor.linear() * direction) : turned(direction, time_s).normalized();
}

Eigen::Vector3d SensorMotion::point_world(const Eigen::Vector3d& point, double time_s) const {
  return position(time_s) + turned(point, time_s);
}

/// The rotation to second order: during a sweep it is small.
Eigen::Vector3d SensorMotion::turned(const Eigen::Vector3d& vector, double time_s) const {
  const Eigen::Vector3d angle = time_s * angular_velocity_sensor;
  const Eigen::Vector3d first = angle.cross(vector);
  return T_world_sensor.linear() * (vector + first + 0.5 * angle.cross(first));
}

SensorMotion motion_at(const Eigen::Isometry3d& T_world_sensor, const Eigen::Vector3d& omega,
                       const Eigen::Vector3d& velocity) {
  return {T_world_sensor, T_world_sensor.linear() * velocity, omega};
}

}  // namespace dynamic_icp::tracking
