// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "dynamic_icp/method/spatial/kd_tree.hpp"

namespace dynamic_icp::spatial {

/// Calls visit(leaf) for the leaves of a tree that is not empty, those with the smallest reach first and without those
/// that are not wanted: for searches that start from more than a point, or go by more than distance.
///
/// `reach(node)` is a lower bound of what counts, such as the distance to the node's box: no greater for a node than
/// for any of its descendants. `wanted(node, reach)` is asked when the turn of the node has come, so that it can
/// make use of what `visit` has found by then; what is not wanted is left out with all its descendants.
template <class Reach, class Wanted, class Visit>
void visit_nearest_first(const KdTree& tree, const Reach& reach, const Wanted& wanted, const Visit& visit) {
  struct Waiting {
    KdTree::Node node;
    double reach;
  };
  std::array<Waiting, 64> waiting;  // one child stays behind at each of at most 28 levels
  std::size_t count = 0;
  waiting[count++] = {tree.root(), reach(tree.root())};
  while (count > 0) {
    const Waiting next = waiting[--count];
    if (!wanted(next.node, next.reach)) {
      continue;
    }
    if (next.node.is_leaf()) {
      visit(next.node);
      continue;
    }
    const Waiting left{next.node.left(), reach(next.node.left())};
    const Waiting right{next.node.right(), reach(next.node.right())};
    waiting[count++] = left.reach <= right.reach ? right : left;
    waiting[count++] = left.reach <= right.reach ? left : right;
  }
}

}  // namespace dynamic_icp::spatial
