// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/speed_profile.hpp"

#include <gtest/gtest.h>

namespace dynamic_icp::world {
namespace {

TEST(SpeedProfile, ConstantSpeed) {
  const SpeedProfile profile(5.0);
  for (const double t : {-2.0, 0.0, 7.0}) {
    EXPECT_EQ(profile.speed_mps(t), 5.0);
    EXPECT_DOUBLE_EQ(profile.distance_m(t), 5.0 * t);
  }
}

TEST(SpeedProfile, GoesThroughItsKnotsWithoutOvershoot) {
  const SpeedProfile profile({{-1.0, 3.0}, {2.0, 8.0}, {5.0, 0.0}, {6.0, 0.0}});
  EXPECT_DOUBLE_EQ(profile.speed_mps(2.0), 8.0);
  EXPECT_NEAR(profile.speed_mps(5.0), 0.0, 1e-15);
  EXPECT_EQ(profile.speed_mps(5.7), 0.0);
  EXPECT_EQ(profile.speed_mps(60.0), 0.0);
  for (double t = -3.0; t < 8.0; t += 0.01) {
    EXPECT_GE(profile.speed_mps(t), 0.0);
    EXPECT_LE(profile.speed_mps(t), 8.0);
  }
  // A half wave covers the mean of its speeds times its time.
  EXPECT_NEAR(profile.distance_m(5.0) - profile.distance_m(2.0), 3.0 * 4.0, 1e-12);
}

TEST(SpeedProfile, DistanceIsTheIntegralOfTheSpeedFromTimeZero) {
  const SpeedProfile profile({{-1.0, 3.0}, {2.0, 8.0}, {5.0, 0.0}, {6.0, 2.0}});
  EXPECT_EQ(profile.distance_m(0.0), 0.0);
  const double h = 1e-5;
  for (double t = -3.0; t < 8.0; t += 0.0371) {
    EXPECT_NEAR((profile.distance_m(t + h) - profile.distance_m(t - h)) / (2.0 * h), profile.speed_mps(t), 1e-8) << t;
  }
}

}  // namespace
}  // namespace dynamic_icp::world
