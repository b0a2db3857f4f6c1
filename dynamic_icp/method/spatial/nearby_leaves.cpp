// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/spatial/nearby_leaves.hpp"

#include "dynamic_icp/method/spatial/tree_walk.hpp"

namespace dynamic_icp::spatial {

bool NearbyLeaves::list(const KdTree& tree, const KdTree::Box& box, double limit) {
  count_ = 0;
  bool too_many = false;
  visit_nearest_first(
      tree, [&](KdTree::Node node) { return squared_distance(box, tree.box(node)); },
      [&](KdTree::Node, double reach) { return reach <= limit && !too_many; },
      [&](KdTree::Node node) {
        too_many = count_ == kCapacity;
        if (too_many) {
          return;
        }
        const KdTree::Box& around = tree.box(node);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          lower_[axis][count_] = around.lower[static_cast<Eigen::Index>(axis)];
          upper_[axis][count_] = around.upper[static_cast<Eigen::Index>(axis)];
        }
        leaves_[count_++] = node.first_leaf;
      });
  for (std::size_t j = count_; j % simd::kLanes != 0; ++j) {  // to full lanes
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lower_[axis][j] = upper_[axis][j] = 0.0;
    }
  }
  return !too_many;
}

}  // namespace dynamic_icp::spatial
