// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/tracking/detection.hpp"
#include "dynamic_icp/method/tracking/oriented_box.hpp"
#include "dynamic_icp/method/tracking/sensor_motion.hpp"

namespace dynamic_icp::tracking {

/// Where one body ends and another one begins, of two that were taken for one.
struct Joint {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< unit, world: along the body, or across it
  double place_m = 0.0;                                  ///< points of one of them have direction . x > place_m
  bool is_across = false;
  bool is_gap = false;         ///< seen while both move alike
  bool is_of_another = false;  ///< of a gap: there is one only if what lies on one side belongs to another track
  double evidence = 0.0;       ///< F; of a gap 0
};

/// Where what is long consists of two bodies, as a lorry and its trailer do, or what is wide. Nothing where one rigid
/// body explains the Doppler as well, by the F statistic of the two regressions of `ClusterVelocity`,
///   F = (S_1 - S_2) / 3 / (S_2 / (n - 6)),
/// with the sums of squares S_1 and S_2 that one and two bodies leave of n points, or where errors of the Doppler by
/// direction explain sqrt((S_1 - S_2) / n). `axes`: those of the box. `yaw_rate_rps` and `sigma_mps`: as in motion_of.
std::optional<Joint> find_joint(const Detection& detection, const Eigen::Matrix3d& axes, double yaw_rate_rps,
                                double sigma_mps);

/// What one scan shows of a body: all rows of its points.
struct GapView {
  const Scan& scan;
  std::span<const std::uint32_t> rows;
  const SensorMotion& sensor;
  const Detection& detection;  ///< of some of them
};

/// Where the side of what is longer than roads allow a lorry has a gap, as between a cab and its trailer: no points
/// above the axles, where there would be 12 and more, nothing nearer before it, and to both sides of it points that lie
/// at most half as far apart as it is wide. What is shorter has gaps, too, but none of 1.2 m unless it is of two
/// bodies: `is_of_another`. `seen`: the part of the box that was seen, world, at the mean time of the detection;
/// `velocity`: m/s, world.
std::optional<Joint> find_gap(const GapView& view, const OrientedBox& seen, const Eigen::Vector3d& velocity);

}  // namespace dynamic_icp::tracking
