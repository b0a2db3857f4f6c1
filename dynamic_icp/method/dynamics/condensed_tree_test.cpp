// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/dynamics/condensed_tree.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace dynamic_icp::dynamics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// An edge that merges at the density `lambda`.
ReachabilityEdge edge(double lambda, std::uint32_t first, std::uint32_t second) {
  return {1.0 / (lambda * lambda), 0.0, first, second};
}

/// Two groups of three, {0, 1, 2} and {3, 4, 5}, that part at lambda 1; point 6 leaves all of them at lambda 0.5.
std::vector<ReachabilityEdge> two_groups() {
  return {edge(8, 3, 4), edge(4, 0, 1), edge(4, 4, 5), edge(2, 1, 2), edge(1, 2, 3), edge(0.5, 5, 6)};
}

TEST(CondensedTree, OnePair) {
  const CondensedTree tree = condense(std::vector{edge(4, 0, 1)}, 2);
  ASSERT_EQ(tree.clusters.size(), 1u);
  EXPECT_EQ(tree.clusters[0].size, 2u);
  EXPECT_EQ(tree.point_cluster, (std::vector<std::uint32_t>{0, 0}));
  EXPECT_EQ(tree.point_lambda, (std::vector<double>{4, 4}));
  EXPECT_EQ(tree.clusters[0].stability, 8.0);
}

TEST(CondensedTree, GroupsAsWorkedOutByHand) {
  const CondensedTree tree = condense(two_groups(), 3);
  ASSERT_EQ(tree.clusters.size(), 3u);
  const std::uint32_t a = tree.point_cluster[0];
  const std::uint32_t b = tree.point_cluster[3];
  EXPECT_EQ(tree.point_cluster, (std::vector<std::uint32_t>{a, a, a, b, b, b, 0}));
  // A group of three falls apart as soon as it loses one point: two are fewer than three.
  EXPECT_EQ(tree.point_lambda, (std::vector<double>{2, 2, 2, 4, 4, 4, 0.5}));
  EXPECT_EQ(tree.clusters[0].size, 7u);
  EXPECT_EQ(tree.clusters[0].birth, 0.0);
  EXPECT_EQ(tree.clusters[0].death, 1.0);
  EXPECT_EQ(tree.clusters[0].stability, 0.5 + 6 * 1.0);
  EXPECT_TRUE(tree.clusters[0].has_children);
  EXPECT_EQ(tree.clusters[a].birth, 1.0);
  EXPECT_EQ(tree.clusters[a].stability, 3 * (2.0 - 1.0));
  EXPECT_EQ(tree.clusters[b].death, 4.0);
  EXPECT_EQ(tree.clusters[b].stability, 3 * (4.0 - 1.0));
  EXPECT_FALSE(tree.clusters[b].has_children);
}

TEST(CondensedTree, SmallerMinimumFollowsTheGroupsFurther) {
  const CondensedTree tree = condense(two_groups(), 2);
  EXPECT_EQ(tree.clusters.size(), 3u);
  EXPECT_EQ(tree.point_lambda, (std::vector<double>{4, 4, 2, 8, 8, 4, 0.5}));
}

TEST(CondensedTree, PointsAtDistanceZeroLeaveTogetherAndNothingIsNaN) {
  // Four points in one place, four in another: two clusters, born at a finite density, that never fall apart.
  std::vector<ReachabilityEdge> edges;
  for (const std::uint32_t first : {0u, 4u}) {
    edges.push_back({0.0, 0.0, first, first + 1});
    edges.push_back({0.0, 0.0, first + 2, first + 3});
    edges.push_back({0.0, 0.0, first, first + 2});  // would part two and two
  }
  edges.push_back(edge(1, 0, 4));
  const CondensedTree tree = condense(edges, 2);
  ASSERT_EQ(tree.clusters.size(), 3u);
  EXPECT_EQ(tree.point_lambda, std::vector<double>(8, kInfinity));
  EXPECT_EQ(tree.clusters[0].stability, 8.0);
  for (const std::uint32_t c : {1u, 2u}) {
    EXPECT_EQ(tree.clusters[c].birth, 1.0);
    EXPECT_EQ(tree.clusters[c].death, kInfinity);
    EXPECT_EQ(tree.clusters[c].stability, kInfinity);
  }
  EXPECT_EQ(select_by_excess_of_mass(tree, false), (std::vector<bool>{false, true, true}));
  EXPECT_EQ(select_by_excess_of_mass(tree, true), (std::vector<bool>{false, true, true}));
}

/// A tree of five clusters: 0 over 1 and 2, 2 over 3 and 4.
CondensedTree family(double root, double second, double third, double fourth) {
  CondensedTree tree;
  tree.clusters.resize(5);
  tree.clusters[2].parent = 0;
  tree.clusters[3].parent = tree.clusters[4].parent = 2;
  const std::vector<double> stabilities{root, 1.0, second, third, fourth};
  for (std::size_t c = 0; c < 5; ++c) {
    tree.clusters[c].stability = stabilities[c];
  }
  return tree;
}

TEST(ExcessOfMass, ParentGivesWayOnlyToStrictlyMore) {
  EXPECT_EQ(select_by_excess_of_mass(family(9, 3, 2, 1), false), (std::vector<bool>{0, 1, 1, 0, 0}));
  EXPECT_EQ(select_by_excess_of_mass(family(9, 3, 2, 1.25), false), (std::vector<bool>{0, 1, 0, 1, 1}));
  EXPECT_EQ(select_by_excess_of_mass(family(9, kInfinity, kInfinity, 1), false), (std::vector<bool>{0, 1, 1, 0, 0}));
}

TEST(ExcessOfMass, RootTakesPartOnlyIfAllowed) {
  EXPECT_EQ(select_by_excess_of_mass(family(9, 3, 2, 1), true), (std::vector<bool>{1, 0, 0, 0, 0}));
  EXPECT_EQ(select_by_excess_of_mass(family(3.5, 3, 2, 1), true), (std::vector<bool>{0, 1, 1, 0, 0}));
  // The best below counts, not the next level: 1 + (2 + 2) > 4.5 although 1 + 3 is less.
  EXPECT_EQ(select_by_excess_of_mass(family(4.5, 3, 2, 2), true), (std::vector<bool>{0, 1, 0, 1, 1}));
}

}  // namespace
}  // namespace dynamic_icp::dynamics
