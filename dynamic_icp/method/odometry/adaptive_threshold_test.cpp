// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/adaptive_threshold.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::odometry {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d motion(const Vector3d& translation, const Vector3d& rotation = Vector3d::Zero()) {
  Isometry3d T = Isometry3d::Identity();
  T.linear() = exp_so3(rotation);
  T.translation() = translation;
  return T;
}

TEST(PointDisplacement, AddsTranslationAndChordOfTheRotation) {
  EXPECT_EQ(point_displacement(Isometry3d::Identity(), 100.0), 0.0);
  EXPECT_NEAR(point_displacement(motion({3.0, 4.0, 0.0}), 100.0), 5.0, 1e-12);
  // 60 degrees: the chord is as long as the radius.
  EXPECT_NEAR(point_displacement(motion({0, 0, 0}, {0, 0, -M_PI / 3.0}), 100.0), 100.0, 1e-10);
  EXPECT_NEAR(point_displacement(motion({0, 2.0, 0}, {M_PI, 0, 0}), 50.0), 102.0, 1e-10);
  EXPECT_NEAR(point_displacement(motion({0, 0, 0}, {1e-9, 0, 0}), 100.0), 1e-7, 1e-16);
}

TEST(AdaptiveThreshold, IsTheInitialOneUntilSomethingIsKnown) {
  AdaptiveThreshold threshold(2.0, 0.1, 100.0);
  EXPECT_EQ(threshold.sigma_m(), 2.0);
  threshold.observe(motion({0.05, 0, 0}), 10.0);  // moved, but the standard deviation is below 0.1 m
  EXPECT_EQ(threshold.sigma_m(), 2.0);
}

TEST(AdaptiveThreshold, IsTheRootMeanSquareOfTheDeviations) {
  AdaptiveThreshold threshold(2.0, 0.1, 100.0);
  threshold.observe(motion({0.3, 0, 0}), 1.0);
  EXPECT_NEAR(threshold.sigma_m(), 0.3, 1e-15);
  threshold.observe(motion({0, 0.4, 0}), 2.0);
  EXPECT_NEAR(threshold.sigma_m(), std::sqrt(0.125), 1e-15);
  threshold.observe(motion({0.09, 0, 0}), 3.0);
  EXPECT_NEAR(threshold.sigma_m(), std::sqrt(0.125), 1e-15) << "too small to count";
  threshold.observe(motion({0.6, 0, 0}, {0, 0, 2.0 * std::asin(0.002)}), 4.0);  // 0.6 + 2 * 100 * 0.002 = 1
  EXPECT_NEAR(threshold.sigma_m(), std::sqrt((0.09 + 0.16 + 1.0) / 3.0), 1e-12);
}

TEST(AdaptiveThreshold, LearnsNothingBeforeTheSensorHasMoved) {
  AdaptiveThreshold threshold(2.0, 0.1, 100.0);
  threshold.observe(motion({0.3, 0, 0}), 0.3);
  EXPECT_EQ(threshold.sigma_m(), 2.0);
  threshold.observe(motion({0.4, 0, 0}), 0.5);  // exactly five times 0.1 m is not beyond it
  EXPECT_EQ(threshold.sigma_m(), 2.0);
  threshold.observe(motion({0.7, 0, 0}), 0.51);
  EXPECT_NEAR(threshold.sigma_m(), 0.7, 1e-15) << "the first two do not count";
}

TEST(AdaptiveThreshold, IsTheInitialOneAgainAtTheFirstPosition) {
  AdaptiveThreshold threshold(2.0, 0.1, 100.0);
  threshold.observe(motion({0.3, 0, 0}), 5.0);
  threshold.observe(motion({0.9, 0, 0}), 0.2);
  EXPECT_EQ(threshold.sigma_m(), 2.0);
  threshold.observe(motion({0.05, 0, 0}), 5.0);
  EXPECT_NEAR(threshold.sigma_m(), 0.3, 1e-15);
}

}  // namespace
}  // namespace dynamic_icp::odometry
