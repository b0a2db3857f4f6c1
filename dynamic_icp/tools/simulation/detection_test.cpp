// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/detection.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace dynamic_icp::simulation {
namespace {

FmcwLidarConfig sensor() {
  FmcwLidarConfig config;
  config.detection_range_m = 100.0;
  return config;
}

TEST(Detection, IsEvenAtTheRangeOfTheSensor) {
  EXPECT_NEAR(detection_probability(sensor(), {100.0, 0.1, 1.0, 1.0}), 0.5, 1e-12);
}

TEST(Detection, IsCertainWhenSwitchedOff) { EXPECT_EQ(detection_probability({}, {1000.0, 0.0, 0.0, 0.0}), 1.0); }

TEST(Detection, FallsToTheRateOfFalseAlarms) {
  EXPECT_NEAR(detection_probability(sensor(), {100.0, 0.0, 1.0, 1.0}), 1e-6, 1e-12);
  EXPECT_NEAR(detection_probability(sensor(), {0.5, 0.3, 1.0, 1.0}), 1.0, 1e-4);
}

TEST(Detection, PowerIsTheProductOfItsCauses) {
  const FmcwLidarConfig config;
  const double power = relative_power(config, {10.0, 0.1, 1.0, 1.0});
  EXPECT_NEAR(power, 0.01, 1e-15);
  EXPECT_NEAR(relative_power(config, {20.0, 0.1, 1.0, 1.0}), power / 4.0, 1e-15);
  EXPECT_NEAR(relative_power(config, {10.0, 0.3, 1.0, 1.0}), power * 3.0, 1e-15);
  EXPECT_NEAR(relative_power(config, {10.0, 0.1, 0.5, 1.0}), power / 2.0, 1e-15);
  EXPECT_NEAR(relative_power(config, {10.0, 0.1, 1.0, 0.2}), power / 5.0, 1e-15);
}

}  // namespace
}  // namespace dynamic_icp::simulation
