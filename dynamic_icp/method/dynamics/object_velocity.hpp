// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/base/scan.hpp"

namespace dynamic_icp::dynamics {

struct ObjectVelocityConfig {
  double lambda = 0.05;                 ///< inliers: residual at most tau_v = lambda * |v_k|
  double min_inlier_fraction = 0.5;     ///< phi_min
  double min_singular_value = 1e-3;     ///< sigma_min of the stacked lines of sight U_k
  double max_condition_number = 400.0;  ///< kappa(U_k)
  // Beyond the paper; off in preset `paper`.
  double huber_delta_mps = 0.0;    ///< Huber regression with this threshold instead of least squares; 0: least squares
  double max_deviation_mps = 0.0;  ///< reject velocities with a standard deviation beyond this in any direction; 0: off
};

ConfigFields fields(ObjectVelocityConfig& config);

/// What became of a cluster.
enum class ClusterVerdict {
  kNotRun,
  kAccepted,
  kTooFewPoints,           ///< fewer than three: three unknowns
  kIllConditioned,         ///< lines of sight too parallel: the velocity across them is not observable
  kTooFewInliers,          ///< no single velocity explains its points
  kInliersIllConditioned,  ///< what is left of it has lines of sight too parallel
  kUncertain,              ///< the velocity is known worse than max_deviation_mps in some direction
};
constexpr ClusterVerdict last_of(ClusterVerdict /*any*/) { return ClusterVerdict::kUncertain; }

std::string_view to_string(ClusterVerdict verdict);

/// One cluster of moving points with its velocity; an accepted one is an object.
struct ObjectEstimate {
  ClusterVerdict verdict = ClusterVerdict::kNotRun;
  Eigen::Vector3d velocity_sensor = Eigen::Vector3d::Zero();  ///< m/s over ground, in the sensor frame of the scan
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();       ///< (m/s)^2, from the residuals; zero if not estimated
  double inlier_fraction = 0.0;
  double smallest_singular_value = 0.0;  ///< of U_k
  double condition_number = 0.0;         ///< of U_k; 0 when the smallest singular value is 0 (infinite)
  std::vector<std::uint32_t> members;    ///< rows of the scan that agree with the velocity; empty unless accepted
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< m, sensor frame, middle of the members' box
  Eigen::Vector3d extent = Eigen::Vector3d::Zero();    ///< m, size of their box along the sensor axes
};

/// Velocity reconstruction of the paper, Eq. (5)-(8), for each cluster label 0, 1, ... in `labels` (one per row of the
/// scan, negative: in no cluster): the test of conditioning, ordinary least squares U_k v_k = s~_k over all its points,
/// and the velocity gate tau_v. Entry k of the result belongs to label k.
///
/// A single gross Doppler error can turn the least squares velocity across the line of sight by tens of m/s; with
/// `huber_delta_mps` the same system is solved by Huber regression instead.
///
/// `compensated` is the Doppler with the sensor's motion taken out (m/s), one per row.
std::vector<ObjectEstimate> reconstruct_velocities(const Scan& scan, std::span<const double> compensated,
                                                   std::span<const std::int32_t> labels,
                                                   const ObjectVelocityConfig& config);

}  // namespace dynamic_icp::dynamics
