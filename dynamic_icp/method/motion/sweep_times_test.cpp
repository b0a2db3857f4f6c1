// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/motion/sweep_times.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace dynamic_icp::motion {
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

TEST(DeclaredTimes, FollowTheOrderInWhichPointsAreStored) {
  SweepConfig config;
  config.declared_duration_s = 0.1;
  config.declared_left_to_right = true;
  config.declared_as_stored = true;
  const std::vector<Eigen::Vector3d> anywhere = {{1, 2, 0}, {1, -2, 0}, {5, 1, 0}};
  const std::vector<double> times = declared_times(anywhere, config);
  ASSERT_EQ(times.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(times[i], 0.05 * static_cast<double>(i), 1e-15);
  }
  EXPECT_EQ(declared_times(std::vector<Eigen::Vector3d>{{1, 0, 0}}, config), std::vector<double>{0.0});
  EXPECT_TRUE(declared_times({}, config).empty());
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

RawScan two_points(std::vector<double> times) {
  RawScan raw;
  raw.points = {{1.0, -1.0, 0.0}, {1.0, 1.0, 0.0}};
  raw.doppler = {0.0, 0.0};
  raw.times = std::move(times);
  return raw;
}

TEST(SweepReport, TakesTheTimesInTheDataAsTheyAre) {
  const RawScan raw = two_points({0.01, 0.09});
  const SweepReport report = sweep_as_configured(raw, {});
  EXPECT_EQ(report.times, SweepTimes::kInData);
  EXPECT_NEAR(report.duration_s.value(), 0.08, 1e-12);
  EXPECT_TRUE(report.deskewed);
  std::vector<double> times;
  EXPECT_EQ(retimed(raw, {}, times).times[1], 0.09);
  EXPECT_TRUE(times.empty());
  EXPECT_FALSE(sweep_in_data(raw).deskewed) << "the data alone do nothing";
}

TEST(SweepReport, DeclaredTimesCountOnlyWhereThereAreNone) {
  SweepConfig config;
  config.declared_duration_s = 0.1;
  const RawScan without = two_points({});
  std::vector<double> times;
  const ScanView declared = retimed(without, config, times);
  ASSERT_EQ(declared.times.size(), 2u);
  EXPECT_NEAR(declared.times[0], 0.0, 1e-12);
  EXPECT_NEAR(declared.times[1], 0.1, 1e-12);
  EXPECT_EQ(sweep_as_configured(without, config).times, SweepTimes::kDeclared);
  const RawScan with = two_points({0.0, 0.05});
  EXPECT_EQ(retimed(with, config, times).times[1], 0.05);
  EXPECT_EQ(sweep_as_configured(with, config).times, SweepTimes::kInData);
}

TEST(SweepReport, SwitchedOffDropsTheTimesAndSaysSo) {
  SweepConfig off;
  off.deskew = false;
  const RawScan raw = two_points({0.0, 0.05});
  std::vector<double> times;
  EXPECT_TRUE(retimed(raw, off, times).times.empty());
  EXPECT_FALSE(sweep_as_configured(raw, off).deskewed);
}

TEST(SweepReport, WithoutTimesThereIsNoSweep) {
  const SweepReport report = sweep_as_configured(two_points({}), {});
  EXPECT_EQ(report.times, SweepTimes::kNone);
  EXPECT_FALSE(report.duration_s.has_value());
  EXPECT_FALSE(report.deskewed);
  EXPECT_FALSE(sweep_in_data(two_points({std::nan(""), std::nan("")})).duration_s.has_value());
}

}  // namespace
}  // namespace dynamic_icp::motion
