// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include <Eigen/Core>

namespace dynamic_icp::ego_motion {

using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

enum class EgoVelocityStatus {
  kNotRun,
  kConverged,
  kIterationLimit,
  kTooFewPoints,  ///< fewer than three: the velocity is the prior
  kFromMotion,    ///< not from the Doppler: the motion between two scans, for methods that do not look for it
  kDegenerate,    ///< the lines of sight leave directions open: along those the velocity is the prior's
  kAmbiguous,     ///< two velocities explain the scan almost equally well, or none does, and no prior decides
};
constexpr EgoVelocityStatus last_of(EgoVelocityStatus /*any*/) { return EgoVelocityStatus::kAmbiguous; }

std::string_view to_string(EgoVelocityStatus status);

/// How fast the sensor rotates.
struct AngularVelocity {
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();       ///< rad/s, sensor axes
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< (rad/s)^2; (10 rad/s)^2 where nothing is known
};

/// The velocity of the sensor over ground, from the Doppler of one scan.
struct EgoVelocity {
  EgoVelocityStatus status = EgoVelocityStatus::kNotRun;
  /// m/s, sensor frame. Of a scan that takes its time: in the middle of it, `reference_time_s` after its stamp.
  Eigen::Vector3d velocity_sensor = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();    ///< (m/s)^2; zero when it cannot be stated
  Eigen::Matrix3d unobservable = Eigen::Matrix3d::Zero();  ///< projector onto the directions left open
  int iterations = 0;
  std::size_t points = 0;
  std::size_t inliers = 0;      ///< residuals that count as static
  double inlier_rms_mps = 0.0;  ///< of those residuals

  // Only from the consensus regression.
  /// d(velocity_sensor)/dt during the scan, m/s^2: v(tau) = velocity_sensor + acceleration_sensor (tau -
  /// reference_time_s) with tau in s after the stamp. For scans taken in an instant what the filter carries on.
  Eigen::Vector3d acceleration_sensor = Eigen::Vector3d::Zero();
  double reference_time_s = 0.0;
  double bias_mps = 0.0;       ///< constant error of the Doppler, s_i = -u_i . v + bias
  double bias_variance = 0.0;  ///< (m/s)^2
  /// Of a rig of several sensors: the angular velocity that the Doppler alone shows.
  std::optional<AngularVelocity> rotation;
  /// Of [velocity; acceleration; bias], for the filter over scans; the parts above are marginal to it.
  Matrix7d joint_covariance = Matrix7d::Zero();
};

}  // namespace dynamic_icp::ego_motion
