// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/spatial/kd_tree.hpp"
#include "dynamic_icp/spatial/nearby_leaves.hpp"
#include "dynamic_icp/spatial/neighbour.hpp"

namespace dynamic_icp::spatial {

/// The nearest point and the one after it; `kNone` as index, at an infinite distance, where there is none.
struct TwoNearest {
  static constexpr std::uint32_t kNone = 0xffffffff;

  Neighbour first{kNone, std::numeric_limits<double>::infinity()};
  Neighbour second{kNone, std::numeric_limits<double>::infinity()};
};

/// Finds the two nearest points of a tree for queries that come in batches: those of a batch share one walk through the
/// tree, which pays when they are near each other. An object serves one thread; the tree must outlive it.
class TwoNearestSearch {
 public:
  /// Points at distance <= `max_distance_m` are found.
  TwoNearestSearch(const KdTree& tree, double max_distance_m);

  /// What `KdTree::nearest_k` finds with k = 2, for each query. One that is not finite finds nothing.
  void search(std::span<const Eigen::Vector3d> queries, std::span<TwoNearest> found);

 private:
  void search_near(const Eigen::Vector3d& query, TwoNearest& found) const;
  void search_alone(const Eigen::Vector3d& query, TwoNearest& found);

  const KdTree& tree_;
  double max_distance_m_;
  double squared_gate_;
  NearbyLeaves leaves_;
  std::vector<Neighbour> alone_;
};

}  // namespace dynamic_icp::spatial
