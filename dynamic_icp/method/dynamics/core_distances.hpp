// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/spatial/kd_tree.hpp"

namespace dynamic_icp::dynamics {

/// The core distance of each point, its distance to the `min_samples`-th nearest other point, and the neighbours that
/// come with it. Points are known by their position in the kd-tree.
struct CoreDistances {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// m^2; followed by infinity up to the end of the last leaf.
  std::vector<double> squared;
  /// Positions of nearest neighbours, `neighbours_each` for each point, nearest first, then kNone. Only those whose
  /// core distance is not greater than the point's own: the mutual reachability distance to them is the core distance
  /// of the point, the least it has to any point.
  std::vector<std::uint32_t> neighbours;
  std::size_t neighbours_each = 0;

  [[nodiscard]] std::span<const std::uint32_t> neighbours_of(std::size_t position) const {
    return std::span(neighbours).subspan(position * neighbours_each, neighbours_each);
  }
};

/// `tree` is the tree over `points`, which are more than `min_samples`. At most 16 neighbours are kept for each point.
CoreDistances core_distances(const spatial::KdTree& tree, std::span<const Eigen::Vector3d> points,
                             std::size_t min_samples, const Workers& workers);

}  // namespace dynamic_icp::dynamics
