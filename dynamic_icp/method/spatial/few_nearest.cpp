// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/spatial/few_nearest.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

namespace dynamic_icp::spatial {

FewNearestSearch::FewNearestSearch(const KdTree& tree, double max_distance_m)
    : tree_(tree), max_distance_m_(max_distance_m), squared_gate_(squared_gate(max_distance_m)) {}

void FewNearestSearch::search(std::span<const Eigen::Vector3d> queries, std::span<FewNearest> found) {
  std::fill(found.begin(), found.end(), FewNearest{});
  constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  KdTree::Box box{Eigen::Array3d::Constant(kUnbounded), Eigen::Array3d::Constant(-kUnbounded)};
  bool empty = true;
  for (const Eigen::Vector3d& query : queries) {
    if (query.allFinite()) {
      box.lower = box.lower.min(query.array());
      box.upper = box.upper.max(query.array());
      empty = false;
    }
  }
  if (empty || tree_.size() == 0) {
    return;
  }
  const bool together = leaves_.list(tree_, box, squared_gate_);
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    for (std::size_t i = 0; i < queries.size(); ++i) {
      if (!queries[i].allFinite()) {
        continue;
      }
      if (together) {
        search_near(queries[i], found[i]);
      } else {
        search_alone(queries[i], found[i]);
      }
    }
  });
}

/// A bit for each row of a leaf whose squared distance is `limit` at most.
DYNAMIC_ICP_INLINE unsigned rows_within(const std::array<double, KdTree::kLeafSize>& squared, double limit) {
  simd::LaneMask bits = {};
  simd::LaneMask weight = {1, 2, 4, 8};
  for (std::size_t i = 0; i < KdTree::kLeafSize; i += simd::kLanes) {
    simd::Lanes distances;
    simd::load(distances, &squared[i]);
    bits |= (distances <= limit) & weight;
    weight <<= 4;
  }
  return static_cast<unsigned>((bits[0] | bits[1]) | (bits[2] | bits[3]));
}

DYNAMIC_ICP_INLINE void FewNearestSearch::search_near(const Eigen::Vector3d& query, FewNearest& found) const {
  NearbyLeaves::Leaves near;
  const std::size_t leaves = leaves_.near(query.x(), query.y(), query.z(), squared_gate_, near);
  std::array<Neighbour, FewNearest::kCapacity + 1> nearest;  // one more, to be pushed out
  std::size_t count = 0;
  double limit = squared_gate_;  // of what may still come in
  for (std::size_t j = 0; j < leaves; ++j) {
    std::array<double, KdTree::kLeafSize> squared;
    distances_to_leaf(tree_.leaf(near[j]), query.x(), query.y(), query.z(), squared.data());
    for (unsigned rest = rows_within(squared, limit); rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rest));
      insert_ordered(nearest.data(), nearest.data() + count,
                     {tree_.order()[near[j] * KdTree::kLeafSize + i], squared[i]});
      count += count < FewNearest::kCapacity ? 1 : 0;
    }
    limit = count == FewNearest::kCapacity ? nearest[count - 1].squared_distance : limit;
  }
  std::copy_n(nearest.begin(), count, found.neighbours.begin());
  found.count = count;
}

void FewNearestSearch::search_alone(const Eigen::Vector3d& query, FewNearest& found) {
  tree_.nearest_k(query, FewNearest::kCapacity, max_distance_m_, alone_);
  std::copy(alone_.begin(), alone_.end(), found.neighbours.begin());
  found.count = alone_.size();
}

}  // namespace dynamic_icp::spatial
