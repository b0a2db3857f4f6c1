// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include <Eigen/Core>

#include "dynamic_icp/base/config_field.hpp"
#include "dynamic_icp/base/parallel.hpp"
#include "dynamic_icp/base/scan.hpp"

namespace dynamic_icp::ego_motion {

struct DopplerRegressionConfig {
  double huber_delta_mps = 0.3;
  int max_iterations = 50;
  double step_tolerance_mps = 1e-5;
};

ConfigFields fields(DopplerRegressionConfig& config);

enum class EgoVelocityStatus {
  kNotRun,
  kConverged,
  kIterationLimit,
  kTooFewPoints,  ///< fewer than three: the velocity is the prior
  kFromMotion,    ///< not from the Doppler: the motion between two scans, for methods that do not look for it
  kDegenerate,    ///< the lines of sight leave directions open: along those the velocity is the prior's
};

std::string_view to_string(EgoVelocityStatus status);

/// The velocity of the sensor over ground, from the Doppler of one scan.
struct EgoVelocity {
  EgoVelocityStatus status = EgoVelocityStatus::kNotRun;
  Eigen::Vector3d velocity_sensor = Eigen::Vector3d::Zero();  ///< m/s, sensor frame
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();       ///< (m/s)^2; zero when it cannot be stated
  Eigen::Matrix3d unobservable = Eigen::Matrix3d::Zero();     ///< projector onto the directions left open
  int iterations = 0;
  std::size_t points = 0;
  std::size_t inliers = 0;      ///< residuals within the Huber threshold
  double inlier_rms_mps = 0.0;  ///< of those residuals
};

/// Robust regression of the paper's Eq. (3): min_v sum rho(s_i + u_i . v) with the Huber loss, by iteratively
/// reweighted least squares from the prior (m/s, sensor frame). The loss is convex: where the lines of sight span all
/// three dimensions the prior decides only how fast the minimum is found.
///
/// The covariance is that of Huber's M-estimator, from the residuals of this scan:
/// [sum psi^2 / (n - 3)] / [mean psi']^2 (U^T U)^-1.
EgoVelocity estimate_velocity(const Scan& scan, const Eigen::Vector3d& prior_sensor,
                              const DopplerRegressionConfig& config, const Workers& workers);

}  // namespace dynamic_icp::ego_motion
