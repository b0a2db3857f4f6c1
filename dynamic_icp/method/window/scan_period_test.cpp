// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/scan_period.hpp"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::window {
namespace {

constexpr double kTenth_s = 0.1;

TEST(ScanPeriod, SaysNothingOfTheFirstScans) {
  ScanPeriod period;
  for (int k = 0; k < 10; ++k) {
    EXPECT_FALSE(period.add(5.0 + kTenth_s * k)) << k;
  }
  const std::optional<KnownValue> interval = period.add(5.0 + kTenth_s * 10);
  ASSERT_TRUE(interval);
  EXPECT_NEAR(interval->value, kTenth_s, 1e-12);
  EXPECT_LT(interval->variance, 1e-20);
}

TEST(ScanPeriod, FollowsNoSingleStamp) {
  ScanPeriod period;
  for (int k = 0; k < 30; ++k) {
    period.add(kTenth_s * k);
  }
  const std::optional<KnownValue> interval = period.add(kTenth_s * 30 + 0.004);
  ASSERT_TRUE(interval);
  EXPECT_NEAR(interval->value, kTenth_s, 1e-12) << "the stamp itself is what is judged";
}

TEST(ScanPeriod, CountsLostScans) {
  ScanPeriod period;
  for (const int k : {0, 1, 2, 4, 5, 6, 7, 10, 11, 12, 13, 15}) {
    period.add(kTenth_s * k);
  }
  const std::optional<KnownValue> interval = period.add(kTenth_s * 18);
  ASSERT_TRUE(interval);
  EXPECT_NEAR(interval->value, 3.0 * kTenth_s, 1e-12);
}

TEST(ScanPeriod, SeesNoneWhereThereIsNone) {
  ScanPeriod period;
  double stamp_s = 0.0;
  for (int k = 0; k < 20; ++k) {
    stamp_s += k % 2 == 0 ? kTenth_s : 1.5 * kTenth_s;
    EXPECT_FALSE(period.add(stamp_s)) << k;
  }
}

/// Its errors are those that its variance says: the mean of their squares over it is 1, for 400 sensors to 7 %.
TEST(ScanPeriod, StatesItsVariance) {
  constexpr int kSensors = 400;
  constexpr int kStamps = 25;
  constexpr double kJitter_s = 1e-3;
  double sum = 0.0;
  for (int sensor = 0; sensor < kSensors; ++sensor) {
    const RandomSource random = RandomSource(7).fork(static_cast<std::uint64_t>(sensor));
    ScanPeriod period;
    for (int k = 0; k < kStamps; ++k) {
      period.add(kTenth_s * k + kJitter_s * random.normal(static_cast<std::uint64_t>(k)));
    }
    const std::optional<KnownValue> interval = period.add(kTenth_s * kStamps);
    ASSERT_TRUE(interval);
    const double error = interval->value - kTenth_s;
    sum += error * error / interval->variance;
  }
  // 23 degrees of freedom: F has the mean 23 / 21 and, over 400, the standard deviation 0.085.
  EXPECT_NEAR(sum / kSensors, 23.0 / 21.0, 0.34);
}

/// The same scan may begin a new map: its stamp comes twice.
TEST(ScanPeriod, TakesAStampOnce) {
  ScanPeriod period;
  for (int k = 0; k < 12; ++k) {
    period.add(kTenth_s * k);
    EXPECT_FALSE(period.add(kTenth_s * k));
  }
  EXPECT_TRUE(period.add(kTenth_s * 12));
}

}  // namespace
}  // namespace dynamic_icp::window
