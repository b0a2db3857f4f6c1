// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/heading_prior.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "dynamic_icp/method/tracking/oriented_box.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d towards(double yaw_rad) { return upright_axes(yaw_rad).col(0); }

TEST(HeadingPrior, IsADensityOfHeadings) {
  HeadingPrior headings;
  headings.add({10.0, 3.0, 0.0}, towards(0.3));
  headings.add({-20.0, 0.0, 0.0}, towards(0.35));
  headings.add({0.0, 30.0, 0.0}, towards(-1.2));
  constexpr int kSteps = 2000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    sum += std::exp(headings.log_ratio({2.0, 1.0, 0.0}, std::numbers::pi * (i + 0.5) / kSteps));
  }
  EXPECT_NEAR(sum / kSteps, 1.0, 1e-6) << "the mean of pi p over a half turn";
}

TEST(HeadingPrior, VehiclesMoveAsThoseBesideThemThisWayOrTheOther) {
  HeadingPrior headings;
  for (const double x : {-10.0, 10.0, 25.0}) {
    headings.add({x, 3.5, 0.0}, towards(0.1));
  }
  headings.add({0.0, -3.5, 0.0}, towards(0.1 + std::numbers::pi));
  const double along = headings.log_ratio(Vector3d::Zero(), 0.1);
  EXPECT_NEAR(headings.log_ratio(Vector3d::Zero(), 0.1 - std::numbers::pi), along, 1e-9);
  EXPECT_GT(along, 1.5);
  EXPECT_LT(headings.log_ratio(Vector3d::Zero(), 1.3), -1.0);
  EXPECT_NEAR(std::remainder(headings.likeliest_yaw(Vector3d::Zero()).value() - 0.1, std::numbers::pi), 0.0, 1e-9);
  // The same headings in axes that are turned.
  HeadingPrior turned;
  turned.clear(upright_axes(0.4));
  for (const double x : {-10.0, 10.0, 25.0}) {
    turned.add({x, 3.5, 0.0}, towards(0.1));
  }
  turned.add({0.0, -3.5, 0.0}, towards(0.1));
  EXPECT_NEAR(turned.log_ratio(Vector3d::Zero(), 0.1 - 0.4), along, 1e-9);
}

TEST(HeadingPrior, NearOnesTellMore) {
  HeadingPrior headings;
  headings.add({5.0, 0.0, 0.0}, towards(0.0));
  headings.add({60.0, 0.0, 0.0}, towards(1.0));
  EXPECT_NEAR(headings.likeliest_yaw(Vector3d::Zero()).value(), 0.0, 1e-9);
  EXPECT_NEAR(headings.likeliest_yaw({70.0, 0.0, 0.0}).value(), 1.0, 1e-9);
  EXPECT_NEAR(headings.log_ratio({1000.0, 0.0, 0.0}, 0.0), 0.0, 1e-6) << "far from all nothing is known";
}

TEST(HeadingPrior, WithoutVehiclesTellsNothing) {
  const HeadingPrior headings;
  EXPECT_EQ(headings.log_ratio(Vector3d::Zero(), 0.7), 0.0);
  EXPECT_FALSE(headings.likeliest_yaw(Vector3d::Zero()));
}

}  // namespace
}  // namespace dynamic_icp::tracking
