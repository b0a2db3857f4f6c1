// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/point_thinning.hpp"

#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace dynamic_icp::figures {
namespace {

/// Half of the points within 2 m of the sensor, the others up to 100 m away.
std::vector<Eigen::Vector3d> dense_near(std::size_t n) {
  std::mt19937 random(7);
  const auto uniform = [&] { return 2.0 * (static_cast<double>(random()) / 4294967296.0) - 1.0; };
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < n; ++i) {
    points.emplace_back(Eigen::Vector3d(uniform(), uniform(), 0.1 * uniform()) * (i % 2 == 0 ? 2.0 : 100.0));
  }
  return points;
}

TEST(PointThinning, KeepsExactlySoManyDifferentRows) {
  const std::vector<Eigen::Vector3d> points = dense_near(1000);
  for (const std::size_t count : {0u, 1u, 2u, 17u, 500u, 999u, 1000u, 5000u}) {
    const std::vector<std::uint32_t> rows = spread_rows(points, count);
    EXPECT_EQ(rows.size(), std::min<std::size_t>(count, 1000));
    EXPECT_EQ(std::set<std::uint32_t>(rows.begin(), rows.end()).size(), rows.size());
  }
  EXPECT_TRUE(spread_rows({}, 5).empty());
}

TEST(PointThinning, SpreadsOverSpaceNotOverPoints) {
  const std::vector<Eigen::Vector3d> points = dense_near(4000);
  std::size_t far = 0;
  for (const std::uint32_t row : spread_rows(points, 400)) {
    far += points[row].cwiseAbs().maxCoeff() > 2.0 ? 1 : 0;
  }
  EXPECT_GT(far, 380u) << "the 4 m around the sensor are a thousandth of the area";
}

TEST(PointThinning, NoPlaceIsLeftOut) {
  // A grid of 64 x 64 points, 1 m apart: of 1024 kept ones every 2 m x 2 m square of the grid has one.
  std::vector<Eigen::Vector3d> points;
  for (int x = 0; x < 64; ++x) {
    for (int y = 0; y < 64; ++y) {
      points.emplace_back(x + 0.5, y + 0.5, 0.0);
    }
  }
  const std::vector<std::uint32_t> rows = spread_rows(points, 1024);
  for (int x = 2; x < 62; ++x) {
    for (int y = 2; y < 62; ++y) {
      const Eigen::Vector3d place(x, y, 0.0);
      EXPECT_TRUE(std::any_of(rows.begin(), rows.end(), [&](std::uint32_t row) {
        return (points[row] - place).cwiseAbs().maxCoeff() < 3.0;
      })) << place.transpose();
    }
  }
}

TEST(PointThinning, TakesPointsOnTopOfEachOtherAndFarOut) {
  std::vector<Eigen::Vector3d> points(100, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(spread_rows(points, 10).size(), 10u);
  points.push_back({1e9, -1e9, 1e300});
  EXPECT_EQ(spread_rows(points, 2).size(), 2u);
  EXPECT_EQ(spread_rows(points, 101).size(), 101u);
}

}  // namespace
}  // namespace dynamic_icp::figures
