// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/spatial/neighbourhoods.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace dynamic_icp::spatial {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr double kAnyReach = std::numeric_limits<double>::infinity();

Points random_points(unsigned seed, std::size_t n, const Eigen::Vector3d& size) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Points points(n);
  for (Eigen::Vector3d& point : points) {
    point = size.cwiseProduct(Eigen::Vector3d(normal(random), normal(random), normal(random)));
  }
  return points;
}

/// Points on walls and a ground, some far away: as in a scan.
Points scan_points(std::size_t n) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Points points(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double far = std::exp(3.0 * uniform(random));
    points[i] = i % 2 == 0 ? Eigen::Vector3d(far, far * uniform(random), -1.0)
                           : Eigen::Vector3d(far, std::copysign(5.0, uniform(random)), far * uniform(random));
  }
  return points;
}

/// All points by distance and index, cut off: the definition.
std::vector<Neighbour> by_hand(const Points& points, std::size_t self, std::size_t k, double max_distance_m) {
  std::vector<Neighbour> all;
  for (std::uint32_t j = 0; j < points.size(); ++j) {
    const double squared = squared_distance(points[j], points[self]);
    if (squared <= squared_gate(max_distance_m)) {
      all.push_back({j, squared});
    }
  }
  std::sort(all.begin(), all.end(), is_nearer);
  all.resize(std::min(k, all.size()));
  return all;
}

/// Leaves [first, end) by one object, in steps of `stride`.
void expect_definition(const Points& points, std::size_t k, double max_distance_m, std::size_t first = 0,
                       std::size_t stride = 1) {
  const KdTree tree(points);
  Neighbourhoods neighbourhoods(tree, k, max_distance_m);
  for (std::size_t leaf = first; leaf < tree.leaf_count(); leaf += stride) {
    neighbourhoods.search(leaf);
    ASSERT_EQ(neighbourhoods.rows(), std::min(KdTree::kLeafSize, points.size() - leaf * KdTree::kLeafSize));
    for (std::size_t row = 0; row < neighbourhoods.rows(); ++row) {
      const std::size_t self = tree.order()[leaf * KdTree::kLeafSize + row];
      std::vector<Neighbour> found;
      ASSERT_EQ(neighbourhoods.positions(row).size(), neighbourhoods.squared_distances(row).size());
      for (std::size_t i = 0; i < neighbourhoods.positions(row).size(); ++i) {
        found.push_back({tree.order()[neighbourhoods.positions(row)[i]], neighbourhoods.squared_distances(row)[i]});
      }
      std::sort(found.begin(), found.end(), is_nearer);
      const std::vector<Neighbour> expected = by_hand(points, self, k, max_distance_m);
      ASSERT_EQ(found.size(), expected.size()) << "point " << self << ", k " << k << ", gate " << max_distance_m;
      for (std::size_t i = 0; i < found.size(); ++i) {
        ASSERT_EQ(found[i].index, expected[i].index);
        ASSERT_EQ(found[i].squared_distance, expected[i].squared_distance);
      }
    }
  }
}

TEST(Neighbourhoods, AreTheNearestPoints) {
  for (const double gate : {kAnyReach, 2.0, 0.3, 0.0}) {
    for (const std::size_t k : {1u, 2u, 11u, 16u, 30u, 200u}) {
      expect_definition(random_points(1, 600, {3.0, 3.0, 3.0}), k, gate);
      expect_definition(random_points(2, 600, {5.0, 5.0, 0.0}), k, gate);
      expect_definition(scan_points(600), k, gate);
    }
  }
}

TEST(Neighbourhoods, DoNotDependOnTheLeavesBefore) {
  for (const std::size_t stride : {1u, 3u, 17u}) {
    for (const std::size_t first : {0u, 1u, 5u}) {
      expect_definition(scan_points(700), 30, 2.0, first, stride);
      expect_definition(scan_points(700), 30, kAnyReach, first, stride);
    }
  }
}

TEST(Neighbourhoods, OfFewPoints) {
  for (const std::size_t n : {1u, 2u, 15u, 16u, 17u, 33u}) {
    for (const std::size_t k : {0u, 1u, 15u, 16u, 17u, 1000u}) {
      expect_definition(random_points(4, n, {1.0, 1.0, 1.0}), k, kAnyReach);
      expect_definition(random_points(4, n, {1.0, 1.0, 1.0}), k, 1.0);
    }
  }
}

TEST(Neighbourhoods, EqualDistancesAreDecidedByIndex) {
  Points grid;
  for (int i = 0; i < 1000; ++i) {
    grid.emplace_back(i * 7 % 10, i * 7 / 10 % 10, i / 100);
  }
  for (const std::size_t k : {2u, 7u, 20u}) {
    expect_definition(grid, k, kAnyReach);
    expect_definition(grid, k, 2.0);
    expect_definition(Points(500, Eigen::Vector3d(1, 2, 3)), k, kAnyReach);
  }
}

TEST(Neighbourhoods, ManyLeavesInReachAreNoHarm) {
  // More leaves than a group may list: all of them touch, or hold nothing but twins.
  Points points = random_points(5, 6000, {1.0, 1.0, 1.0});
  expect_definition(points, 30, 100.0, 0, 60);
  expect_definition(points, 1500, 100.0, 0, 90);
  points.assign(6000, Eigen::Vector3d::Ones());
  expect_definition(points, 30, kAnyReach, 0, 60);
}

TEST(Neighbourhoods, SquaresThatOverflowFindNothingWrong) {
  const Points far{{1e150, 0, 0}, {-1e150, 0, 0}, {0, 0, 0}, {0, 1e-200, 0}};
  expect_definition(far, 3, kAnyReach);
  expect_definition(far, 3, 1e160);
}

TEST(Neighbourhoods, NegativeGatesFindNothing) {
  expect_definition(random_points(6, 50, {1.0, 1.0, 1.0}), 5, -1.0);
  expect_definition(random_points(6, 50, {1.0, 1.0, 1.0}), 5, std::nan(""));
}

}  // namespace
}  // namespace dynamic_icp::spatial
