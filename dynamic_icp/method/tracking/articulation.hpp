// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include <Eigen/Core>

#include "dynamic_icp/method/tracking/detection.hpp"

namespace dynamic_icp::tracking {

/// Where a long body consists of two, as a lorry and its trailer do: what is farther along the horizontal direction
/// `along` (unit, world) than the result (m: along . x) moves as one rigid body, the rest as another one. Nothing where
/// one rigid body explains the Doppler as well, by the F statistic of the two regressions of `ClusterVelocity`,
///   F = (S_1 - S_2) / 3 / (S_2 / (n - 6)),
/// with the sums of squares S_1 and S_2 that one and two bodies leave of n points, or where errors of the Doppler by
/// direction explain sqrt((S_1 - S_2) / n). `yaw_rate_rps` and `sigma_mps`: as in motion_of.
std::optional<double> find_joint(const Detection& detection, const Eigen::Vector3d& along, double yaw_rate_rps,
                                 double sigma_mps);

}  // namespace dynamic_icp::tracking
