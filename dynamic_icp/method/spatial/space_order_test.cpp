// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/spatial/space_order.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace dynamic_icp::spatial {
namespace {

std::vector<Eigen::Vector3d> random_points(std::size_t n, double size) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-size, size);
  std::vector<Eigen::Vector3d> points(n);
  for (Eigen::Vector3d& p : points) {
    p = {uniform(random), uniform(random), uniform(random)};
  }
  return points;
}

TEST(SpaceOrder, HasEveryRowOnce) {
  for (const std::size_t n : {0u, 1u, 2u, 5000u}) {
    for (const double size : {0.1, 20.0, 1e150}) {
      std::vector<std::uint32_t> order = space_order(random_points(n, size), 0.5);
      std::sort(order.begin(), order.end());
      ASSERT_EQ(order.size(), n);
      for (std::uint32_t i = 0; i < n; ++i) {
        ASSERT_EQ(order[i], i);
      }
    }
  }
}

TEST(SpaceOrder, IsMortonsOrderOfTheCells) {
  // The definition: of two cells the one comes first whose bits, interlaced from the top, do.
  const std::vector<Eigen::Vector3d> points = random_points(2000, 30.0);
  const std::vector<std::uint32_t> order = space_order(points, 0.5);
  const auto key = [&](std::uint32_t row) {
    std::vector<bool> bits;
    for (int bit = 9; bit >= 0; --bit) {
      for (int axis = 2; axis >= 0; --axis) {
        bits.push_back((static_cast<int>(std::floor(points[row][axis] / 0.5)) + 512) >> bit & 1);
      }
    }
    return bits;
  };
  for (std::size_t i = 1; i < order.size(); ++i) {
    ASSERT_TRUE(key(order[i - 1]) < key(order[i]) || (key(order[i - 1]) == key(order[i]) && order[i - 1] < order[i]));
  }
}

}  // namespace
}  // namespace dynamic_icp::spatial
