// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/dynamics/mutual_reachability.hpp"

#include <algorithm>
#include <random>
#include <stdexcept>
#include <tuple>

#include <gtest/gtest.h>

#include "dynamic_icp/method/spatial/disjoint_sets.hpp"

namespace dynamic_icp::dynamics {
namespace {

using Points = std::vector<Eigen::Vector3d>;

double squared_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double dx = a.x() - b.x();
  const double dy = a.y() - b.y();
  const double dz = a.z() - b.z();
  return (dx * dx + dy * dy) + dz * dz;
}

Points sorted(Points points) {
  std::sort(points.begin(), points.end(), [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());
  });
  return points;
}

/// Kruskal's algorithm over all pairs of points.
std::vector<ReachabilityEdge> all_pairs_tree(const Points& points, std::size_t min_samples) {
  const auto n = static_cast<std::uint32_t>(points.size());
  std::vector<double> core(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    std::vector<double> others;
    for (std::uint32_t j = 0; j < n; ++j) {
      if (j != i) {
        others.push_back(squared_distance(points[i], points[j]));
      }
    }
    std::sort(others.begin(), others.end());
    core[i] = others[min_samples - 1];
  }
  std::vector<ReachabilityEdge> edges;
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = i + 1; j < n; ++j) {
      const double length = squared_distance(points[i], points[j]);
      edges.push_back({std::max({core[i], core[j], length}), length, i, j});
    }
  }
  std::sort(edges.begin(), edges.end());
  spatial::DisjointSets sets(n);
  std::erase_if(edges, [&](const ReachabilityEdge& e) { return !sets.unite(e.first, e.second); });
  return edges;
}

void expect_same_tree(const Points& points, std::initializer_list<int> min_samples) {
  for (const int k : min_samples) {
    const auto expected = all_pairs_tree(points, static_cast<std::size_t>(k));
    for (const int threads : {1, 3}) {
      ASSERT_EQ(mutual_reachability_tree(points, k, Workers(threads)), expected)
          << points.size() << " points, min_samples " << k;
    }
  }
}

Points uniform_points(std::mt19937& random, std::size_t n, const Eigen::Vector3d& size_m) {
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  Points points(n);
  for (Eigen::Vector3d& p : points) {
    p = Eigen::Vector3d(uniform(random), uniform(random), uniform(random)).cwiseProduct(size_m);
  }
  return points;
}

TEST(MutualReachability, FewPoints) {
  std::mt19937 random(1);
  expect_same_tree(sorted(uniform_points(random, 2, {1, 1, 1})), {1});
  expect_same_tree(sorted(uniform_points(random, 5, {1, 1, 1})), {1, 2, 4});
  expect_same_tree(sorted(uniform_points(random, 33, {1, 1, 1})), {1, 10, 32});
}

TEST(MutualReachability, RandomPoints) {
  std::mt19937 random(2);
  for (int repeat = 0; repeat < 5; ++repeat) {
    expect_same_tree(sorted(uniform_points(random, 400, {4, 4, 4})), {1, 3, 10, 25});
    expect_same_tree(sorted(uniform_points(random, 400, {40, 4, 0})), {2, 10});
    expect_same_tree(sorted(uniform_points(random, 300, {100, 0, 0})), {1, 10});
  }
}

TEST(MutualReachability, BlobsFarApart) {
  std::mt19937 random(3);
  Points points;
  for (const double x : {0.0, 1e2, 1e5, -1e7}) {
    for (const Eigen::Vector3d& p : uniform_points(random, 90, {1, 2, 3})) {
      points.push_back(p + Eigen::Vector3d(x, 0.3 * x, -x));
    }
  }
  expect_same_tree(sorted(points), {1, 5, 10, 60});
}

TEST(MutualReachability, IdenticalPoints) {
  std::mt19937 random(4);
  Points points = uniform_points(random, 40, {2, 2, 2});
  for (int i = 0; i < 300; ++i) {
    points.push_back(points[random() % (i % 3 == 0 ? 40 : 4)]);
  }
  expect_same_tree(sorted(points), {1, 4, 10, 50});
  expect_same_tree(Points(100, Eigen::Vector3d(1, 2, 3)), {1, 10, 99});
}

TEST(MutualReachability, GridsFullOfTies) {
  Points plane;
  Points cube;
  for (int i = 0; i < 343; ++i) {
    plane.emplace_back(i % 18, i / 18, 0.0);
    cube.emplace_back(i % 7, i / 7 % 7, i / 49);
  }
  expect_same_tree(sorted(plane), {1, 4, 10});
  expect_same_tree(sorted(cube), {1, 6, 10, 30});
}

TEST(MutualReachability, TiesAcrossGaps) {
  // Ragged blocks of a grid, four steps apart: many equal edges join two blocks, and only searches find them.
  std::mt19937 random(5);
  for (int repeat = 0; repeat < 20; ++repeat) {
    Points blocks;
    for (int i = 0; i < 300; ++i) {
      const auto step = [&](unsigned steps) { return static_cast<double>(random() % steps); };
      blocks.emplace_back(step(6) + 9.0 * step(2), step(6) + 9.0 * step(2), step(4));
    }
    expect_same_tree(sorted(blocks), {1, 3, 6});
  }
}

TEST(MutualReachability, RefusesWhatItCannotUse) {
  const Points points{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}};
  EXPECT_NO_THROW(mutual_reachability_tree(points, 2, Workers(1)));
  EXPECT_THROW(mutual_reachability_tree(points, 3, Workers(1)), std::invalid_argument);
  EXPECT_THROW(mutual_reachability_tree(points, 0, Workers(1)), std::invalid_argument);
  EXPECT_THROW(mutual_reachability_tree(Points(points.rbegin(), points.rend()), 1, Workers(1)), std::invalid_argument);
  EXPECT_THROW(mutual_reachability_tree({}, 1, Workers(1)), std::invalid_argument);
}

}  // namespace
}  // namespace dynamic_icp::dynamics
