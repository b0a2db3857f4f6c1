// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/spatial/tree_walk.hpp"

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace dynamic_icp::spatial {
namespace {

std::vector<Eigen::Vector3d> random_points(std::size_t n) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Eigen::Vector3d> points(n);
  for (Eigen::Vector3d& p : points) {
    p = {uniform(random), uniform(random), uniform(random)};
  }
  return points;
}

TEST(TreeWalk, VisitsExactlyTheLeavesWithinReach) {
  for (const std::size_t n : {1u, 16u, 17u, 1000u}) {
    const KdTree tree(random_points(n));
    const KdTree::Box box{Eigen::Array3d(0.2, 0.2, 0.2), Eigen::Array3d(0.3, 0.4, 0.5)};
    for (const double gate : {0.0, 0.01, 0.25, std::numeric_limits<double>::infinity()}) {
      std::vector<std::uint32_t> visited;
      std::vector<std::uint32_t> expected;
      visit_nearest_first(
          tree, [&](KdTree::Node node) { return squared_distance(box, tree.box(node)); },
          [&](KdTree::Node node, double reach) {
            if (node.is_leaf() && reach <= gate) {
              expected.push_back(node.first_leaf);
            }
            return reach <= gate;
          },
          [&](KdTree::Node leaf) { visited.push_back(leaf.first_leaf); });
      EXPECT_EQ(visited, expected);
      // Every leaf whose box is within the gate must be there, found without the tree's structure.
      std::size_t within = 0;
      for (std::size_t leaf = 0; leaf < tree.leaf_count(); ++leaf) {
        KdTree::Box around{Eigen::Array3d::Constant(1e9), Eigen::Array3d::Constant(-1e9)};
        for (std::size_t p = leaf * KdTree::kLeafSize; p < std::min(n, (leaf + 1) * KdTree::kLeafSize); ++p) {
          const Eigen::Array3d row = tree.leaf(leaf).row(static_cast<Eigen::Index>(p % KdTree::kLeafSize)).transpose();
          around = {around.lower.min(row), around.upper.max(row)};
        }
        within += squared_distance(box, around) <= gate ? 1 : 0;
      }
      EXPECT_EQ(visited.size(), within);
    }
  }
}

TEST(TreeWalk, TheFirstLeafIsTheNearestAndLimitsMayShrink) {
  const KdTree tree(random_points(1000));
  const Eigen::Vector3d query(3.0, 0.1, 0.2);
  double nearest = std::numeric_limits<double>::infinity();
  std::size_t visits = 0;
  visit_nearest_first(
      tree, [&](KdTree::Node node) { return squared_distance(tree.box(node), query); },
      [&](KdTree::Node, double reach) { return reach <= nearest; },
      [&](KdTree::Node leaf) {
        ++visits;
        nearest = std::min(nearest, squared_distances(tree.leaf(leaf.first_leaf), query).minCoeff());
      });
  EXPECT_EQ(nearest, tree.nearest(query, 10.0)->squared_distance);
  EXPECT_LT(visits, tree.leaf_count() / 4);
}

}  // namespace
}  // namespace dynamic_icp::spatial
