// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/traffic_prior.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "dynamic_icp/method/tracking/oriented_box.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d towards(double yaw_rad) { return upright_axes(yaw_rad).col(0); }

TEST(TrafficPrior, IsADensityOfHeadings) {
  TrafficPrior traffic;
  traffic.add({10.0, 3.0, 0.0}, towards(0.3), 10.0);
  traffic.add({-20.0, 0.0, 0.0}, towards(0.35), 10.0);
  traffic.add({0.0, 30.0, 0.0}, towards(-1.2), 10.0);
  constexpr int kSteps = 2000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    sum += std::exp(traffic.log_ratio_of_heading({2.0, 1.0, 0.0}, std::numbers::pi * (i + 0.5) / kSteps));
  }
  EXPECT_NEAR(sum / kSteps, 1.0, 1e-6) << "the mean of pi p over a half turn";
}

TEST(TrafficPrior, VehiclesMoveAsThoseBesideThemThisWayOrTheOther) {
  TrafficPrior traffic;
  for (const double x : {-10.0, 10.0, 25.0}) {
    traffic.add({x, 3.5, 0.0}, towards(0.1), 10.0);
  }
  traffic.add({0.0, -3.5, 0.0}, towards(0.1 + std::numbers::pi), 10.0);
  const double along = traffic.log_ratio_of_heading(Vector3d::Zero(), 0.1);
  EXPECT_NEAR(traffic.log_ratio_of_heading(Vector3d::Zero(), 0.1 - std::numbers::pi), along, 1e-9);
  EXPECT_GT(along, 1.5);
  EXPECT_LT(traffic.log_ratio_of_heading(Vector3d::Zero(), 1.3), -1.0);
  EXPECT_NEAR(std::remainder(traffic.likeliest_yaw(Vector3d::Zero()).value() - 0.1, std::numbers::pi), 0.0, 1e-9);
  // The same headings in axes that are turned.
  TrafficPrior turned;
  turned.clear(upright_axes(0.4));
  for (const double x : {-10.0, 10.0, 25.0}) {
    turned.add({x, 3.5, 0.0}, towards(0.1), 10.0);
  }
  turned.add({0.0, -3.5, 0.0}, towards(0.1), 10.0);
  EXPECT_NEAR(turned.log_ratio_of_heading(Vector3d::Zero(), 0.1 - 0.4), along, 1e-9);
}

TEST(TrafficPrior, NearOnesTellMore) {
  TrafficPrior traffic;
  traffic.add({5.0, 0.0, 0.0}, towards(0.0), 10.0);
  traffic.add({60.0, 0.0, 0.0}, towards(1.0), 10.0);
  EXPECT_NEAR(traffic.likeliest_yaw(Vector3d::Zero()).value(), 0.0, 1e-9);
  EXPECT_NEAR(traffic.likeliest_yaw({70.0, 0.0, 0.0}).value(), 1.0, 1e-9);
  EXPECT_NEAR(traffic.log_ratio_of_heading({1000.0, 0.0, 0.0}, 0.0), 0.0, 1e-6) << "far from all nothing is known";
}

TEST(TrafficPrior, IsADensityOfSpeeds) {
  TrafficPrior traffic;
  traffic.add({10.0, 3.0, 0.0}, towards(0.3), 12.0);
  traffic.add({-20.0, 0.0, 0.0}, towards(0.35), 30.0);
  constexpr double kAny_mps = 20.0;
  constexpr double kStep_mps = 0.01;
  double sum = 0.0;
  for (double v = 0.5 * kStep_mps; v < 200.0; v += kStep_mps) {
    const double any =
        2.0 * std::exp(-0.5 * v * v / (kAny_mps * kAny_mps)) / (std::sqrt(2.0 * std::numbers::pi) * kAny_mps);
    sum += kStep_mps * any * std::exp(traffic.log_ratio_of_speed({2.0, 1.0, 0.0}, v, kAny_mps));
  }
  EXPECT_NEAR(sum, 1.0, 1e-3);
}

TEST(TrafficPrior, VehiclesAreAsFastAsThoseAround) {
  TrafficPrior traffic;
  for (const double x : {-10.0, 10.0, 25.0}) {
    traffic.add({x, 3.5, 0.0}, towards(0.0), 2.0);
  }
  const double with_them = traffic.log_ratio_of_speed(Vector3d::Zero(), 2.5, 20.0);
  EXPECT_GT(with_them, 0.5);
  EXPECT_LT(traffic.log_ratio_of_speed(Vector3d::Zero(), 13.0, 20.0), -0.5) << "in a jam";
  EXPECT_NEAR(traffic.log_ratio_of_speed({1000.0, 0.0, 0.0}, 13.0, 20.0), 0.0, 1e-6) << "far from it";
}

TEST(TrafficPrior, WithoutVehiclesTellsNothing) {
  const TrafficPrior traffic;
  EXPECT_EQ(traffic.log_ratio_of_heading(Vector3d::Zero(), 0.7), 0.0);
  EXPECT_NEAR(traffic.log_ratio_of_speed(Vector3d::Zero(), 3.0, 20.0), 0.0, 1e-12);
  EXPECT_FALSE(traffic.likeliest_yaw(Vector3d::Zero()));
}

}  // namespace
}  // namespace dynamic_icp::tracking
