// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/base/config_field.hpp"
#include "dynamic_icp/base/scan.hpp"

namespace dynamic_icp::dynamics {

struct ObjectVelocityConfig {
  double lambda = 0.05;                 ///< inliers: residual at most tau_v = lambda * |v_k|
  double min_inlier_fraction = 0.5;     ///< phi_min
  double min_singular_value = 1e-3;     ///< sigma_min of the stacked lines of sight U_k
  double max_condition_number = 400.0;  ///< kappa(U_k)
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
};

std::string_view to_string(ClusterVerdict verdict);

/// One cluster of moving points with its velocity; an accepted one is an object.
struct ObjectEstimate {
  ClusterVerdict verdict = ClusterVerdict::kNotRun;
  Eigen::Vector3d velocity_sensor = Eigen::Vector3d::Zero();  ///< m/s over ground, in the sensor frame of the scan
  std::size_t cluster_points = 0;
  double inlier_fraction = 0.0;
  double smallest_singular_value = 0.0;  ///< of U_k
  double condition_number = 0.0;         ///< of U_k; 0 when the smallest singular value is 0 (infinite)
  std::vector<std::uint32_t> members;    ///< rows of the scan that agree with the velocity; empty unless accepted
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< m, sensor frame, middle of the members' box
  Eigen::Vector3d extent = Eigen::Vector3d::Zero();    ///< m, size of their box along the sensor axes
};

/// Velocity reconstruction of the paper, Eq. (5)-(8), for each cluster label 0, 1, ... in `labels` (one per row of the
/// scan, negative: in no cluster): ordinary least squares U_k v_k = s~_k over all its points, then the test of
/// conditioning and the velocity gate tau_v. Entry k of the result belongs to label k.
///
/// `compensated` is the Doppler with the sensor's motion taken out (m/s), one per row.
std::vector<ObjectEstimate> reconstruct_velocities(const Scan& scan, std::span<const double> compensated,
                                                   std::span<const std::int32_t> labels,
                                                   const ObjectVelocityConfig& config);

}  // namespace dynamic_icp::dynamics
