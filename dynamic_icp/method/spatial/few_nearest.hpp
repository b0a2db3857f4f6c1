// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/spatial/kd_tree.hpp"
#include "dynamic_icp/method/spatial/nearby_leaves.hpp"
#include "dynamic_icp/method/spatial/neighbour.hpp"

namespace dynamic_icp::spatial {

/// The nearest points of a query, in the order of `is_nearer`.
struct FewNearest {
  static constexpr std::size_t kCapacity = 8;

  std::array<Neighbour, kCapacity> neighbours{};
  std::size_t count = 0;  ///< of those, the first ones
};

/// Finds the few nearest points of a tree for queries that come in batches: those of a batch share one walk through the
/// tree, which pays when they are near each other. An object serves one thread; the tree must outlive it.
class FewNearestSearch {
 public:
  /// Points at distance <= `max_distance_m` are found.
  FewNearestSearch(const KdTree& tree, double max_distance_m);

  /// What `KdTree::nearest_k` finds with k = `FewNearest::kCapacity`, for each query. One that is not finite finds
  /// nothing.
  void search(std::span<const Eigen::Vector3d> queries, std::span<FewNearest> found);

 private:
  void search_near(const Eigen::Vector3d& query, FewNearest& found) const;
  void search_alone(const Eigen::Vector3d& query, FewNearest& found);

  const KdTree& tree_;
  double max_distance_m_;
  double squared_gate_;
  NearbyLeaves leaves_;
  std::vector<Neighbour> alone_;
};

}  // namespace dynamic_icp::spatial
