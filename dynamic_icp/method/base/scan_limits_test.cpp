// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/scan_limits.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace dynamic_icp {
namespace {

std::vector<double> sweep(std::size_t count, double duration_s) {
  std::vector<double> times;
  for (std::size_t i = 0; i < count; ++i) {
    times.push_back(duration_s * static_cast<double>(i) / static_cast<double>(count - 1));
  }
  return times;
}

TEST(PlausibleTimes, HoldASweepOfAnyDuration) {
  for (const double duration_s : {0.0, 1e-6, 0.1, 1.0, 20.0}) {
    const TimeWindow window = plausible_times(sweep(10'000, duration_s));
    EXPECT_TRUE(window.contains(0.0)) << duration_s;
    EXPECT_TRUE(window.contains(duration_s)) << duration_s;
    EXPECT_FALSE(window.contains(2.0 * duration_s + 0.11)) << duration_s;
  }
}

// Most returns from a wall that takes a hundredth of the sweep, the others anywhere.
TEST(PlausibleTimes, HoldPointsThatCrowd) {
  std::vector<double> times = sweep(200, 0.1);
  times.insert(times.end(), 10'000, 0.099);
  const TimeWindow window = plausible_times(times);
  EXPECT_TRUE(window.contains(0.0));
  EXPECT_TRUE(window.contains(0.1));
}

TEST(PlausibleTimes, AreNotMovedByDamage) {
  std::vector<double> times = sweep(1000, 0.1);
  const double damage[] = {
      1e30, -1e30, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 10.0, -3.0};
  for (std::size_t k = 0; k < 30; ++k) {
    times[31 * k] = damage[k % std::size(damage)];
  }
  const TimeWindow window = plausible_times(times);
  EXPECT_GT(window.min_s, -0.15);
  EXPECT_LT(window.max_s, 0.25);
  EXPECT_FALSE(window.contains(std::numeric_limits<double>::quiet_NaN()));
}

TEST(PlausibleTimes, OfNoUsableTimeAreThoseOfAnyScan) {
  EXPECT_TRUE(plausible_times({}).contains(kMaxPointTime_s));
  EXPECT_FALSE(plausible_times(std::vector<double>{1e9, -1e9}).contains(1e9));
}

}  // namespace
}  // namespace dynamic_icp
