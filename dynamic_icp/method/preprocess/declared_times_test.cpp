// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/preprocess/declared_times.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace dynamic_icp::preprocess {
namespace {

std::vector<Eigen::Vector3d> fan() {
  std::vector<Eigen::Vector3d> points;
  for (int k = -6; k <= 6; ++k) {
    const double azimuth = 0.1 * k;
    points.emplace_back((5.0 + k) * std::cos(azimuth) + 0.0, (5.0 + k) * std::sin(azimuth), 0.3 * k);
  }
  points.erase(points.begin());  // range -1: behind the sensor
  points.erase(points.begin());  // range 0
  return points;
}

TEST(DeclaredTimes, GrowEvenlyWithTheAzimuth) {
  SweepConfig config;
  config.declared_duration_s = 0.1;
  const auto times = declared_times(fan(), config);
  ASSERT_EQ(times.size(), 11u);
  for (std::size_t k = 0; k < times.size(); ++k) {
    EXPECT_NEAR(times[k], 0.01 * static_cast<double>(k), 1e-12);
  }
}

TEST(DeclaredTimes, RunTheOtherWayWhenToldSo) {
  SweepConfig config;
  config.declared_duration_s = 0.1;
  const auto forth = declared_times(fan(), config);
  config.declared_left_to_right = true;
  const auto back = declared_times(fan(), config);
  for (std::size_t k = 0; k < forth.size(); ++k) {
    EXPECT_NEAR(forth[k] + back[k], 0.1, 1e-12);
  }
}

TEST(DeclaredTimes, AreFiniteForAnyPoints) {
  SweepConfig config;
  config.declared_duration_s = 0.1;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Eigen::Vector3d> points = {{nan, 1.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 0.0, 1.0}};
  for (const double time : declared_times(points, config)) {
    EXPECT_TRUE(std::isfinite(time));
  }
  EXPECT_TRUE(declared_times({}, config).empty());
}

}  // namespace
}  // namespace dynamic_icp::preprocess
