// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include <Eigen/Core>

#include "dynamic_icp/method/tracking/detection.hpp"

namespace dynamic_icp::tracking {

/// Where one body ends and another one begins, of two that were taken for one.
struct Joint {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< unit, world: along the body, or across it
  double place_m = 0.0;                                  ///< points of one of them have direction . x > place_m
  bool is_across = false;
  double evidence = 0.0;  ///< F
};

/// Where what is long consists of two bodies, as a lorry and its trailer do, or what is wide. Nothing where one rigid
/// body explains the Doppler as well, by the F statistic of the two regressions of `ClusterVelocity`,
///   F = (S_1 - S_2) / 3 / (S_2 / (n - 6)),
/// with the sums of squares S_1 and S_2 that one and two bodies leave of n points, or where errors of the Doppler by
/// direction explain sqrt((S_1 - S_2) / n). `axes`: those of the box. `yaw_rate_rps` and `sigma_mps`: as in motion_of.
std::optional<Joint> find_joint(const Detection& detection, const Eigen::Matrix3d& axes, double yaw_rate_rps,
                                double sigma_mps);

}  // namespace dynamic_icp::tracking
