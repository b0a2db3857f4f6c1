// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/dynamics/core_distances.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "testing/random_points.hpp"

namespace dynamic_icp::dynamics {
namespace {

void expect_brute_force(const Points& points, std::size_t min_samples, int threads) {
  const spatial::KdTree tree(points);
  const CoreDistances cores = core_distances(tree, points, min_samples, Workers(threads));
  std::vector<double> expected;
  for (const std::uint32_t self : tree.order()) {
    std::vector<double> others;
    for (std::size_t j = 0; j < points.size(); ++j) {
      if (j != self) {
        others.push_back(spatial::squared_length(points[self] - points[j]));
      }
    }
    std::sort(others.begin(), others.end());
    expected.push_back(others[min_samples - 1]);
  }
  ASSERT_GE(cores.squared.size(), points.size());
  ASSERT_TRUE(std::equal(expected.begin(), expected.end(), cores.squared.begin()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    double last = 0.0;
    for (const std::uint32_t neighbour : cores.neighbours_of(i)) {
      if (neighbour == CoreDistances::kNone) {
        continue;
      }
      ASSERT_NE(neighbour, i);
      ASSERT_LE(expected[neighbour], expected[i]);
      const double distance = spatial::squared_length(points[tree.order()[i]] - points[tree.order()[neighbour]]);
      ASSERT_LE(last, distance);
      ASSERT_LE(distance, expected[i]);
      last = distance;
    }
  }
}

TEST(CoreDistances, AgreeWithBruteForce) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  Points points(700);
  for (Eigen::Vector3d& p : points) {
    p = Eigen::Vector3d(normal(random), normal(random), normal(random)).array().cube();
  }
  for (const std::size_t min_samples : {1u, 2u, 10u, 40u, 699u}) {
    expect_brute_force(points, min_samples, 1);
    expect_brute_force(points, min_samples, 3);
  }
}

TEST(CoreDistances, OfIdenticalPointsAndGrids) {
  Points points;
  for (int i = 0; i < 500; ++i) {
    points.emplace_back(i % 5, i / 5 % 6, i % 7 / 4);
  }
  for (const std::size_t min_samples : {1u, 3u, 10u, 30u}) {
    expect_brute_force(points, min_samples, 2);
    expect_brute_force(Points(100, Eigen::Vector3d::Ones()), min_samples, 2);
  }
}

TEST(CoreDistances, OfTwoPoints) {
  const Points points{{0.0, 0.0, 0.0}, {3.0, 4.0, 0.0}};
  const CoreDistances cores = core_distances(spatial::KdTree(points), points, 1, Workers(1));
  EXPECT_EQ(cores.squared[0], 25.0);
  EXPECT_EQ(cores.squared[1], 25.0);
  EXPECT_EQ(cores.neighbours_of(0)[0], 1u);
  EXPECT_EQ(cores.neighbours_of(1)[0], 0u);
}

}  // namespace
}  // namespace dynamic_icp::dynamics
