// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/coordinates.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> random_points(std::size_t count) {
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) {
    const RandomSource one = RandomSource(3).fork(i);
    points.emplace_back(one.uniform(0, -9.0, 9.0), one.uniform(1, 2.0, 3.0), one.uniform(2, -5.0, -4.0));
  }
  return points;
}

TEST(Coordinates, AreThoseOfThePoints) {
  const std::vector<Vector3d> points = random_points(Coordinates::kMaxPoints);
  Coordinates at;
  at.take(points.data(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(Vector3d(at.x[i], at.y[i], at.z[i]), points[i]);
  }
}

TEST(Coordinates, TheIntervalHoldsAllValuesAndNoMore) {
  std::vector<double> values{3.0};
  for (std::uint64_t i = 0; i < 20; ++i) {
    const Interval interval = interval_around(values);
    EXPECT_EQ(interval.low, *std::min_element(values.begin(), values.end()));
    EXPECT_EQ(interval.high, *std::max_element(values.begin(), values.end()));
    values.push_back(RandomSource(5).uniform(i, -9.0, 9.0));
  }
}

}  // namespace
}  // namespace dynamic_icp::tracking
