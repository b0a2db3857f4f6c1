// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/motion/motion_uncertainty.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace dynamic_icp::motion {
namespace {

TEST(UnknownDirections, NameTheAxisOfATunnel) {
  Matrix6d covariance = 1e-8 * Matrix6d::Identity();
  covariance(3, 3) = 0.25;
  const auto unknown = unobservable_directions(covariance, 30.0, 0.1);
  ASSERT_EQ(unknown.size(), 1u);
  EXPECT_NEAR(std::abs(unknown[0].direction[3]), 1.0, 1e-9);
  EXPECT_TRUE(unobservable_directions(1e-8 * Matrix6d::Identity(), 30.0, 0.1).empty());
}

TEST(UnknownDirections, WeighRotationsByTheirLever) {
  Matrix6d covariance = 1e-10 * Matrix6d::Identity();
  covariance(2, 2) = 0.01 * 0.01;  // 0.01 rad: 0.3 m at 30 m
  EXPECT_EQ(unobservable_directions(covariance, 30.0, 0.1).size(), 1u);
  EXPECT_TRUE(unobservable_directions(covariance, 5.0, 0.1).empty());
}

}  // namespace
}  // namespace dynamic_icp::motion
