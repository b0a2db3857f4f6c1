// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/spatial/kd_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::spatial {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr double kAnyDistance = std::numeric_limits<double>::infinity();

double squared_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double dx = a.x() - b.x();
  const double dy = a.y() - b.y();
  const double dz = a.z() - b.z();
  return (dx * dx + dy * dy) + dz * dz;
}

/// All points within the distance, ordered by distance and index: the definition of what a search may return.
std::vector<Neighbour> brute_force(const Points& points, const Eigen::Vector3d& query, double max_distance_m) {
  std::vector<Neighbour> all;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = squared_distance(points[i], query);
    if (distance <= max_distance_m * max_distance_m) {
      all.push_back({static_cast<std::uint32_t>(i), distance});
    }
  }
  std::sort(all.begin(), all.end(), [](const Neighbour& a, const Neighbour& b) {
    return std::pair(a.squared_distance, a.index) < std::pair(b.squared_distance, b.index);
  });
  return all;
}

void expect_same_as_brute_force(const Points& points, const Points& queries) {
  const KdTree tree(points);
  ASSERT_EQ(tree.size(), points.size());
  std::vector<Neighbour> found;
  for (const Eigen::Vector3d& query : queries) {
    for (const double max_distance_m : {0.0, 0.3, 2.0, kAnyDistance}) {
      const std::vector<Neighbour> expected = brute_force(points, query, max_distance_m);
      const std::optional<Neighbour> nearest = tree.nearest(query, max_distance_m);
      ASSERT_EQ(nearest.has_value(), !expected.empty());
      if (nearest) {
        ASSERT_EQ(nearest->index, expected.front().index);
        ASSERT_EQ(nearest->squared_distance, expected.front().squared_distance);
      }
      for (const std::size_t k : {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{30}, points.size() + 3}) {
        tree.nearest_k(query, k, max_distance_m, found);
        ASSERT_EQ(found.size(), std::min(k, expected.size()));
        for (std::size_t i = 0; i < found.size(); ++i) {
          ASSERT_EQ(found[i].index, expected[i].index);
          ASSERT_EQ(found[i].squared_distance, expected[i].squared_distance);
        }
      }
    }
  }
}

Points random_points(std::mt19937& random, std::size_t n, double half_width_m) {
  std::uniform_real_distribution<double> uniform(-half_width_m, half_width_m);
  Points points(n);
  for (Eigen::Vector3d& p : points) {
    p = {uniform(random), uniform(random), uniform(random)};
  }
  return points;
}

TEST(KdTree, EmptyTreeFindsNothing) {
  const KdTree tree(Points{});
  std::vector<Neighbour> found(3);
  tree.nearest_k(Eigen::Vector3d::Zero(), 5, kAnyDistance, found);
  EXPECT_TRUE(found.empty());
  EXPECT_FALSE(tree.nearest(Eigen::Vector3d::Zero(), kAnyDistance));
  EXPECT_EQ(tree.leaf_count(), 0u);
}

TEST(KdTree, FewPoints) {
  std::mt19937 random(1);
  for (const std::size_t n : {1u, 2u, 3u, 15u, 16u, 17u, 31u, 32u, 33u, 48u, 49u}) {
    const Points points = random_points(random, n, 1.5);
    Points queries = random_points(random, 10, 2.0);
    queries.insert(queries.end(), points.begin(), points.end());
    expect_same_as_brute_force(points, queries);
  }
}

TEST(KdTree, RandomPoints) {
  std::mt19937 random(2);
  const Points points = random_points(random, 1500, 4.0);
  Points queries = random_points(random, 60, 5.0);
  queries.insert(queries.end(), points.begin(), points.begin() + 30);
  queries.emplace_back(1e9, -1e9, 3.0);
  expect_same_as_brute_force(points, queries);
}

TEST(KdTree, DuplicatesAreFoundInTheOrderOfTheirIndices) {
  std::mt19937 random(3);
  Points points = random_points(random, 40, 1.0);
  for (int i = 0; i < 400; ++i) {
    points.push_back(points[static_cast<std::size_t>(i * i) % 40]);
  }
  std::shuffle(points.begin(), points.end(), random);
  expect_same_as_brute_force(points, Points(points.begin(), points.begin() + 60));
  expect_same_as_brute_force(Points(300, Eigen::Vector3d(1.0, 2.0, 3.0)), {{1.0, 2.0, 3.0}, {1.0, 2.0, 4.0}});
}

TEST(KdTree, ManyIdenticalPointsDoNotMakeASearchVisitThemAll) {
  // Visiting every leaf for every query would take minutes here.
  const std::size_t n = 100'000;
  const KdTree tree(Points(n, Eigen::Vector3d(1.0, 2.0, 3.0)));
  std::vector<Neighbour> found;
  for (std::size_t i = 0; i < n; ++i) {
    tree.nearest_k({1.0, 2.0, 3.0}, 11, kAnyDistance, found);
    ASSERT_EQ(found.back().index, 10u);
    ASSERT_EQ(tree.nearest({1.0, 2.0, 4.0}, 5.0)->index, 0u);
  }
}

TEST(KdTree, CollinearPoints) {
  Points points;
  for (int i = 0; i < 700; ++i) {
    points.emplace_back(0.5 * (i * 37 % 700), 0.25 * (i * 37 % 700), 7.0);
  }
  expect_same_as_brute_force(points, {{0.0, 0.0, 7.0}, {30.2, 15.1, 7.0}, {100.0, 0.0, 0.0}, {1e4, 1e4, 1e4}});
}

TEST(KdTree, GridWithManyEqualDistances) {
  Points points;
  for (int i = 0; i < 9 * 9 * 9; ++i) {
    const int j = i * 400 % 729;  // a permutation: 400 and 729 have no common factor
    points.emplace_back(j % 9, j / 9 % 9, j / 81);
  }
  Points queries(points.begin(), points.begin() + 20);
  queries.emplace_back(4.5, 4.5, 4.5);
  queries.emplace_back(4.0, 4.5, 2.5);
  queries.emplace_back(-1.0, 4.0, 4.0);
  expect_same_as_brute_force(points, queries);
}

TEST(KdTree, ClustersFarApart) {
  std::mt19937 random(4);
  Points points;
  for (const double x : {-1e6, 0.0, 3e5, 1e8}) {
    for (const Eigen::Vector3d& p : random_points(random, 200, 1.0)) {
      points.push_back(p + Eigen::Vector3d(x, -x, 0.5 * x));
    }
  }
  Points queries = random_points(random, 20, 1e6);
  queries.insert(queries.end(), points.begin() + 190, points.begin() + 210);
  expect_same_as_brute_force(points, queries);
}

TEST(KdTree, QueriesWithoutMeaningFindNothing) {
  const KdTree tree(Points{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Neighbour> found;
  for (const Eigen::Vector3d& query : Points{{nan, 0.0, 0.0}, {0.0, kAnyDistance, 0.0}, {0.0, 0.0, -kAnyDistance}}) {
    EXPECT_FALSE(tree.nearest(query, kAnyDistance));
    tree.nearest_k(query, 2, kAnyDistance, found);
    EXPECT_TRUE(found.empty());
  }
  EXPECT_FALSE(tree.nearest(Eigen::Vector3d::Zero(), -1.0));
  EXPECT_FALSE(tree.nearest(Eigen::Vector3d::Zero(), nan));
  // The square of this distance is infinite: no such number may leave.
  EXPECT_FALSE(tree.nearest(Eigen::Vector3d(1e200, 0.0, 0.0), kAnyDistance));
}

TEST(KdTree, RefusesPointsThatAreNotFinite) {
  for (const double bad : {kAnyDistance, -kAnyDistance, std::numeric_limits<double>::quiet_NaN(), 1e151}) {
    for (int axis = 0; axis < 3; ++axis) {
      Points points(5, Eigen::Vector3d::Zero());
      points[3][axis] = bad;
      EXPECT_THROW(KdTree{points}, DataError);
    }
  }
}

TEST(KdTree, DoesNotAllocateOnceTheResultHasGrown) {
  std::mt19937 random(5);
  const KdTree tree(random_points(random, 500, 1.0));
  std::vector<Neighbour> found;
  found.reserve(10);
  const Neighbour* memory = found.data();
  tree.nearest_k(Eigen::Vector3d::Zero(), 10, kAnyDistance, found);
  EXPECT_EQ(found.data(), memory);
  EXPECT_EQ(found.capacity(), 10u);
}

TEST(KdTree, ThreadsBuildTheSameTree) {
  std::mt19937 random(7);
  for (const std::size_t n : {0u, 1u, 17u, 40u, 300u, 5000u}) {
    Points points = random_points(random, n, 1.0);
    std::fill(points.begin() + static_cast<std::ptrdiff_t>(n / 2), points.end(), Eigen::Vector3d::Zero());
    const KdTree expected(points);
    for (const int threads : {2, 7}) {
      const KdTree tree(points, Workers(threads));
      ASSERT_TRUE(
          std::equal(tree.order().begin(), tree.order().end(), expected.order().begin(), expected.order().end()));
      for (const Eigen::Vector3d& query : random_points(random, 20, 1.0)) {
        const auto a = tree.nearest(query, kAnyDistance);
        const auto b = expected.nearest(query, kAnyDistance);
        ASSERT_EQ(a.has_value(), b.has_value());
        ASSERT_EQ(a ? a->index : 0, b ? b->index : 0);
      }
    }
  }
}

/// Collects the leaves under `node` and checks what the structure promises on the way.
void check_node(const KdTree& tree, KdTree::Node node, std::size_t depth, std::set<std::uint32_t>& ids,
                std::vector<std::uint32_t>& leaves) {
  ASSERT_LT(node.id, tree.node_count());
  ASSERT_TRUE(ids.insert(node.id).second);
  const std::size_t begin = node.first_leaf * KdTree::kLeafSize;
  const std::size_t end = std::min(node.end_leaf * KdTree::kLeafSize, tree.size());
  Eigen::Array3d lower = Eigen::Array3d::Constant(kAnyDistance);
  Eigen::Array3d upper = -lower;
  for (std::size_t p = begin; p < end; ++p) {
    const auto row = tree.leaf(p / KdTree::kLeafSize).row(static_cast<Eigen::Index>(p % KdTree::kLeafSize));
    lower = lower.min(row.transpose());
    upper = upper.max(row.transpose());
  }
  EXPECT_TRUE((tree.box(node).lower == lower).all());
  EXPECT_TRUE((tree.box(node).upper == upper).all());
  EXPECT_LE(depth, static_cast<std::size_t>(std::ceil(std::log2(static_cast<double>(tree.leaf_count())))));
  if (node.is_leaf()) {
    leaves.push_back(node.first_leaf);
    return;
  }
  check_node(tree, node.left(), depth + 1, ids, leaves);
  check_node(tree, node.right(), depth + 1, ids, leaves);
}

TEST(KdTree, StructureForWalkers) {
  std::mt19937 random(6);
  for (const std::size_t n : {1u, 16u, 17u, 100u, 1000u, 1025u}) {
    Points points = random_points(random, n, 1.0);
    std::fill(points.begin() + static_cast<std::ptrdiff_t>(n / 2), points.end(), points.front());
    const KdTree tree(points);
    std::set<std::uint32_t> ids;
    std::vector<std::uint32_t> leaves;
    check_node(tree, tree.root(), 0, ids, leaves);
    EXPECT_EQ(ids.size(), tree.node_count());
    ASSERT_EQ(leaves.size(), tree.leaf_count());
    for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf) {
      EXPECT_EQ(leaves[leaf], leaf);
    }
    ASSERT_EQ(tree.order().size(), n);
    EXPECT_EQ(std::set<std::uint32_t>(tree.order().begin(), tree.order().end()).size(), n);
    for (std::size_t p = 0; p < n; ++p) {
      const auto row = tree.leaf(p / KdTree::kLeafSize).row(static_cast<Eigen::Index>(p % KdTree::kLeafSize));
      EXPECT_EQ(Eigen::Vector3d(row.transpose()), points[tree.order()[p]]);
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::spatial
