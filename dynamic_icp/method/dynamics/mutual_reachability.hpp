// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"

namespace dynamic_icp::dynamics {

/// An edge of the spanning tree between two points, first < second.
struct ReachabilityEdge {
  double squared_weight = 0.0;  ///< m^2, max(core(first)^2, core(second)^2, |first - second|^2)
  double squared_length = 0.0;  ///< m^2, |first - second|^2
  std::uint32_t first = 0;
  std::uint32_t second = 0;

  /// The order of edges: weight, then length, then the numbers of the points. Equal weights are not an exception: a
  /// point in sparse surroundings has the same mutual reachability distance, its own core distance, to each of its
  /// nearest neighbours. The length lets it join the nearest of them first, and the numbers settle the rest.
  auto operator<=>(const ReachabilityEdge&) const = default;
};

/// The minimum spanning tree of all points under the mutual reachability distance
///   d(a, b) = max(core(a), core(b), |a - b|),  core(a) = distance from a to its `min_samples`-th nearest other point,
/// sorted by the order of edges. That order has no ties, so the tree is unique: it depends on the points and their
/// numbers, not on the way it is found nor on the number of threads.
///
/// `points` must be ordered lexicographically (identical points stand side by side) and must be more than
/// `min_samples` >= 1; throws std::invalid_argument otherwise and DataError as spatial::KdTree does.
/// Exact; Boruvka's algorithm over a kd-tree. Memory grows with n * min(min_samples, 16).
std::vector<ReachabilityEdge> mutual_reachability_tree(std::span<const Eigen::Vector3d> points, int min_samples,
                                                       const Workers& workers);

}  // namespace dynamic_icp::dynamics
