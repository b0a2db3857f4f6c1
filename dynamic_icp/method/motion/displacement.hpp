// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace dynamic_icp::motion {

/// A velocity of the sensor at one time.
struct VelocitySample {
  double time_s = 0.0;
  Eigen::Vector3d velocity_sensor = Eigen::Vector3d::Zero();   ///< m/s, in the axes at that time
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();        ///< (m/s)^2, in the same axes
  Eigen::Matrix3d R_map_sensor = Eigen::Matrix3d::Identity();  ///< at that time
};

/// The displacement of the sensor between two times, as the sum of turned velocities.
struct Displacement {
  Eigen::Vector3d fixed_map = Eigen::Vector3d::Zero();  ///< m, from all samples but the last
  double last_weight_s = 0.0;                           ///< of the last sample: + last_weight_s R_map_sensor velocity
  Eigen::Matrix3d covariance_map = Eigen::Matrix3d::Zero();  ///< m^2, of the whole
};

/// c_j with sum c_j f(t_j) = integral of f from `begin_s` to `end_s` for every polynomial f of a degree below the
/// number of times: for three scans with equal steps, and the interval between the last two, dt (-1/12, 8/12, 5/12).
/// The times must differ.
std::vector<double> quadrature_weights(std::span<const double> times_s, double begin_s, double end_s);

/// The integral of the velocity in map axes from `begin_s` to `end_s` through the samples. The last sample is kept
/// apart because its rotation is still to be found. Where times nearly coincide the oldest samples are left out. See
/// docs/derivations/displacement-from-doppler.md.
Displacement displacement_between(std::span<const VelocitySample> samples, double begin_s, double end_s);

}  // namespace dynamic_icp::motion
