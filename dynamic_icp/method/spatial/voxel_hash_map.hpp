// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/spatial/key_numbers.hpp"
#include "dynamic_icp/method/spatial/neighbour.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::spatial {

/// Points that come and go, sorted into cubic voxels: the local map of an odometry. A point p lies in the voxel
/// floor(p / voxel_size_m). Each voxel keeps the first points that fall into it, as measured, until it is full.
///
/// All results depend on the order of the calls alone, not on how the hash spreads the voxels. Searches may run at the
/// same time; adding and removing may not run beside anything.
class VoxelHashMap {
 public:
  /// Throws std::invalid_argument unless both are above zero.
  VoxelHashMap(double voxel_size_m, int max_points_per_voxel);

  /// Adds the points in their order; those whose voxel is full are left out, as are those that lie 2^30 voxels or more
  /// from the origin along an axis or are not finite.
  void add(std::span<const Eigen::Vector3d> points);

  /// Removes each voxel whose first point is farther than `max_distance_m` from `position`, with all its points.
  void remove_far(const Eigen::Vector3d& position, double max_distance_m);

  /// The nearest point at most `max_distance_m` away in the voxel of `query` and the 26 around it; nothing when these
  /// hold none. Points more than one voxel away may be missed: that is the price of a search of constant time. The
  /// index belongs to `point`; of equally near points the one of the older voxel is found, in a voxel the older point.
  [[nodiscard]] std::optional<Neighbour> nearest(const Eigen::Vector3d& query, double max_distance_m) const;

  /// The point that `nearest` named; valid until points are added or removed.
  [[nodiscard]] const Eigen::Vector3d& point(std::uint32_t index) const { return points_[index]; }

  /// All points, by the age of their voxels and by their own age in the voxel.
  [[nodiscard]] std::vector<Eigen::Vector3d> points() const;

  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] bool empty() const { return counts_.empty(); }

  void state(StateArchive& archive);

 private:
  using Cell = std::array<std::int32_t, 3>;

  [[nodiscard]] std::optional<Cell> cell_of(const Eigen::Vector3d& point) const;
  [[nodiscard]] double squared_gap(const Eigen::Vector3d& query, const Cell& cell) const;
  void number_voxels();

  double voxel_size_m_;
  std::uint32_t capacity_;
  NumbersOf<Cell> voxels_;               ///< by age
  std::vector<std::uint32_t> counts_;    ///< of each voxel: points in it; never 0
  std::vector<Eigen::Vector3d> points_;  ///< capacity_ places for each voxel
};

}  // namespace dynamic_icp::spatial
