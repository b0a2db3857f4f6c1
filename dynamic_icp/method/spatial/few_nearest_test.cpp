// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/spatial/few_nearest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace dynamic_icp::spatial {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Points random_points(unsigned seed, std::size_t n, double size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  Points points(n);
  for (Eigen::Vector3d& point : points) {
    point = {uniform(random), uniform(random), uniform(random)};
  }
  return points;
}

FewNearest by_hand(const Points& points, const Eigen::Vector3d& query, double max_distance_m) {
  std::vector<Neighbour> all;
  for (std::uint32_t j = 0; j < points.size(); ++j) {
    const double squared = squared_distance(points[j], query);
    if (squared <= squared_gate(max_distance_m)) {
      all.push_back({j, squared});
    }
  }
  std::sort(all.begin(), all.end(), is_nearer);
  FewNearest found;
  found.count = std::min(all.size(), FewNearest::kCapacity);
  std::copy_n(all.begin(), found.count, found.neighbours.begin());
  return found;
}

void expect_definition(const Points& points, const Points& queries, double max_distance_m, std::size_t batch) {
  const KdTree tree(points);
  FewNearestSearch search(tree, max_distance_m);
  std::vector<FewNearest> found(queries.size());
  for (std::size_t i = 0; i < queries.size(); i += batch) {
    const std::size_t size = std::min(batch, queries.size() - i);
    search.search(std::span(queries).subspan(i, size), std::span(found).subspan(i, size));
  }
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const FewNearest expected = by_hand(points, queries[i], max_distance_m);
    ASSERT_EQ(found[i].count, expected.count);
    for (std::size_t k = 0; k < expected.count; ++k) {
      ASSERT_EQ(found[i].neighbours[k].index, expected.neighbours[k].index);
      ASSERT_EQ(found[i].neighbours[k].squared_distance, expected.neighbours[k].squared_distance);
    }
  }
}

TEST(FewNearest, AgreeWithBruteForce) {
  const Points points = random_points(1, 1000, 3.0);
  const Points queries = random_points(2, 200, 4.0);
  for (const double gate : {0.0, 0.2, 0.6, 2.0, kInfinity}) {
    for (const std::size_t batch : {1u, 7u, 16u}) {
      expect_definition(points, queries, gate, batch);
    }
  }
  expect_definition(random_points(3, 6000, 1.0), random_points(4, 100, 1.0), 0.5, 16);  // more leaves than a list holds
}

TEST(FewNearest, EqualDistancesAreDecidedByIndex) {
  Points grid;
  for (int i = 0; i < 1000; ++i) {
    grid.emplace_back(i * 7 % 10, i * 7 / 10 % 10, i / 100);
  }
  Points queries = grid;
  for (Eigen::Vector3d& query : queries) {
    query += Eigen::Vector3d(0.5, 0.5, 0.0);
  }
  expect_definition(grid, queries, 3.0, 16);
  expect_definition(grid, grid, 3.0, 16);
}

TEST(FewNearest, OfLittleOrNothing) {
  expect_definition({}, random_points(5, 10, 1.0), 1.0, 4);
  expect_definition({{0.1, 0.0, 0.0}}, random_points(5, 10, 1.0), 1.0, 4);
  expect_definition(random_points(6, 50, 1.0), random_points(5, 10, 1.0), -1.0, 4);
  const KdTree tree(random_points(6, 50, 1.0));
  FewNearestSearch search(tree, kInfinity);
  const Points queries{{0, 0, 0}, {std::nan(""), 0, 0}, {0, kInfinity, 0}, {0.5, 0, 0}};
  std::vector<FewNearest> found(queries.size());
  search.search(queries, found);
  EXPECT_EQ(found[0].count, FewNearest::kCapacity);
  EXPECT_EQ(found[1].count, 0u);
  EXPECT_EQ(found[2].count, 0u);
  EXPECT_EQ(found[3].count, FewNearest::kCapacity);
}

}  // namespace
}  // namespace dynamic_icp::spatial
