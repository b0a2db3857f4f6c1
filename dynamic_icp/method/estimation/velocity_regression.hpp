// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"

namespace dynamic_icp::estimation {

/// What is known of the lines of sight before the regression.
enum class Rank {
  kFull,     ///< they span all three dimensions well: the caller has checked it
  kUnknown,  ///< directions that they do not observe are found and left alone
};

struct VelocityRegressionConfig {
  double huber_delta_mps = 0.0;  ///< residuals beyond this lose weight; infinity: ordinary least squares, one step
  int max_iterations = 50;
  double step_tolerance_mps = 1e-6;  ///< converged when a step is shorter
  Rank rank = Rank::kUnknown;
};

struct VelocityRegression {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      ///< m/s, in the axes of the lines of sight
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();    ///< (m/s)^2; zero for three rows or fewer
  Eigen::Matrix3d unobservable = Eigen::Matrix3d::Zero();  ///< projector onto the directions left alone
  int iterations = 0;
  bool converged = false;
  std::size_t inliers = 0;      ///< residuals of at most huber_delta_mps
  double inlier_rms_mps = 0.0;  ///< of those residuals
};

/// The velocity v of what has the range rates r_i = u_i . v along the unit vectors u_i: min_v sum rho(u_i . v - r_i)
/// with the Huber loss, by iteratively reweighted least squares. Without a start the first step takes all residuals for
/// small. The loss is convex: where the u_i span all three dimensions the start decides only how fast the minimum is
/// found. Along directions that no u_i observes, v is the start's.
///
/// The covariance is that of Huber's M-estimator, from the residuals: [sum psi^2 / (n - 3)] / [mean psi']^2 (U^T U)^-1.
/// The same bits for any number of threads.
VelocityRegression regress_velocity(std::span<const Eigen::Vector3d> directions, std::span<const double> range_rates,
                                    const std::optional<Eigen::Vector3d>& start, const VelocityRegressionConfig& config,
                                    const Workers& workers);

}  // namespace dynamic_icp::estimation
