// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include <Eigen/Core>

namespace dynamic_icp::tracking {

/// What objects stand on.
struct Ground {
  /// Columns: two directions in the ground and its upward normal, axes of the world.
  Eigen::Matrix3d level = Eigen::Matrix3d::Identity();
  std::optional<double> offset_m;  ///< points x on the ground have up . x = offset; empty: not seen

  [[nodiscard]] Eigen::Vector3d up() const { return level.col(2); }
};

/// The ground after `last` where a scan from `sensor_world` (m) shows a plane of points x with `normal` . x = `offset_m`
/// (world). The direction follows slowly, the height at once. What is steep against the last ground is a wall: `last`
/// stays.
Ground updated_ground(const Ground& last, const Eigen::Vector3d& normal, double offset_m,
                      const Eigen::Vector3d& sensor_world);

}  // namespace dynamic_icp::tracking
