// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace dynamic_icp::tracking {

/// Where the sensor is during one scan: a pose at the stamp and a constant twist after it.
struct SensorMotion {
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();   ///< at the stamp
  Eigen::Vector3d velocity_world = Eigen::Vector3d::Zero();           ///< m/s
  Eigen::Vector3d angular_velocity_sensor = Eigen::Vector3d::Zero();  ///< rad/s

  [[nodiscard]] Eigen::Vector3d position(double time_s) const;  ///< in the world, so long after the stamp

  [[nodiscard]] Eigen::Isometry3d pose(double time_s) const;  ///< T_world_sensor so long after the stamp

  /// A line of sight measured so long after the stamp, in world axes.
  [[nodiscard]] Eigen::Vector3d direction_world(const Eigen::Vector3d& direction, double time_s) const;

  /// A point measured so long after the stamp, as it was seen then, in the world.
  [[nodiscard]] Eigen::Vector3d point_world(const Eigen::Vector3d& point, double time_s) const;

 private:
  [[nodiscard]] Eigen::Vector3d turned(const Eigen::Vector3d& vector, double time_s) const;
};

/// From a pose and the velocities there: `omega` (rad/s) and `velocity` (m/s), sensor axes.
SensorMotion motion_at(const Eigen::Isometry3d& T_world_sensor, const Eigen::Vector3d& omega,
                       const Eigen::Vector3d& velocity);

}  // namespace dynamic_icp::tracking
