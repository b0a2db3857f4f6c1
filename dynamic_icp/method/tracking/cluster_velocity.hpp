// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <Eigen/Core>

namespace dynamic_icp::tracking {

/// What the Doppler of one scan says about a rigid body. All of its points obey r(u) = u . W with
///   W = V - Omega x c,
/// V the velocity of its reference point, c that point seen from the sensor and Omega its angular velocity: the Doppler
/// cannot tell V from the turning. W is well known along the line of sight, and across it only as far as the body
/// fills an angle. The information matrix says how well.
struct ClusterVelocity {
  Eigen::Vector3d W = Eigen::Vector3d::Zero();            ///< m/s, axes of the lines of sight
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< inverse covariance of W, (s/m)^2; may be singular
  double spread_mps = 0.0;                                ///< robust standard deviation of the residuals
  double signal_mps = 0.0;                                ///< root mean square of u . W over the points
};

/// Regression of `radial` (m/s, the points' own range rates over ground) on the lines of sight with Tukey's kernel,
/// whose scale follows the spread of the residuals and is never below `sigma_mps`, the noise of a good measurement.
/// Starts from the median range rate. Directions that the lines of sight leave open come out as zero. Without points
/// everything is zero.
ClusterVelocity fit_cluster_velocity(std::span<const Eigen::Vector3d> directions, std::span<const double> radial,
                                     double sigma_mps);

}  // namespace dynamic_icp::tracking
