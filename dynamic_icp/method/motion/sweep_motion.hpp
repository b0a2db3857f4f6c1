// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::motion {

/// How the sensor moves while it takes a scan: velocity and angular velocity, both changing linearly. All vectors are
/// in the axes of the sensor, which turn with it; tau is in s after the stamp of the scan.
struct SweepMotion {
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();         ///< rad/s at the stamp
  Eigen::Vector3d alpha = Eigen::Vector3d::Zero();         ///< rad/s^2: omega(tau) = omega + alpha tau
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      ///< m/s over ground at the stamp
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< m/s^2: v(tau) = velocity + acceleration tau

  /// R_stamp_tau = exp([omega tau + alpha tau^2 / 2]x); the turns of a scan are small enough to add up like vectors.
  [[nodiscard]] Eigen::Matrix3d rotation(double tau) const;

  /// v(tau) in the axes at tau, m/s.
  [[nodiscard]] Eigen::Vector3d velocity_at(double tau) const { return velocity + tau * acceleration; }

  /// T_stamp_tau: moves a point measured at tau to where it would have been measured at the stamp. The displacement is
  /// the integral of R_stamp_tau v(tau) by Simpson's rule.
  [[nodiscard]] Eigen::Isometry3d pose(double tau) const;
};

/// The constant-velocity model: the twist [omega (rad/s); velocity (m/s)] in sensor axes stays what it is.
inline SweepMotion constant_sweep(const Vector6d& twist) {
  SweepMotion sweep;
  sweep.omega = twist.head<3>();
  sweep.velocity = twist.tail<3>();
  return sweep;
}

}  // namespace dynamic_icp::motion
