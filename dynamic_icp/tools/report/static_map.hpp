// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/spatial/voxel_hash_map.hpp"

namespace dynamic_icp::report {

/// The static points of a drive in its world frame, one for each occupied cubic cell: the first that fell into it.
/// Cells grow as the map fills, so that memory stays bounded however long the drive is.
class StaticMap {
 public:
  static constexpr double kFinestCell_m = 0.1;

  /// Cells grow by a fourth whenever there would be more than `max_points`.
  explicit StaticMap(std::size_t max_points);

  /// Adds points (m, sensor frame) at the pose. Those farther than 100,000 km from the start are left out.
  void add(std::span<const Eigen::Vector3d> points, const Eigen::Isometry3d& T_world_sensor);

  /// Makes the map smaller still: at most `max_points`.
  void limit(std::size_t max_points);

  [[nodiscard]] double cell_m() const { return cell_m_; }
  /// m, spread along Morton's curve, so that neighbours follow each other.
  [[nodiscard]] std::vector<Eigen::Vector3d> points() const;

 private:
  std::size_t max_points_;
  double cell_m_ = kFinestCell_m;
  spatial::VoxelHashMap voxels_;
};

}  // namespace dynamic_icp::report
