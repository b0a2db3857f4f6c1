// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::motion {

/// How the sensor moves at the stamp of a scan, in its own axes.
struct Twist {
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< rad/s
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< m/s over ground
  Matrix6d covariance = Matrix6d::Zero();             ///< of [angular; linear]
};

// The constant-velocity model: the sensor keeps its twist [angular (rad/s); linear (m/s)] in its own axes.

/// T_begin_end of a sensor with a constant twist, `duration_s` from begin to end.
inline Eigen::Isometry3d motion_of(const Vector6d& twist, double duration_s) { return exp_se3(duration_s * twist); }
inline Eigen::Isometry3d motion_of(const Eigen::Vector3d& angular, const Eigen::Vector3d& linear, double duration_s) {
  return motion_of((Vector6d() << angular, linear).finished(), duration_s);
}

/// The constant twist that makes this motion in `duration_s`.
inline Vector6d mean_twist(const Eigen::Isometry3d& T_begin_end, double duration_s) {
  return log_se3(T_begin_end) / duration_s;
}

}  // namespace dynamic_icp::motion
