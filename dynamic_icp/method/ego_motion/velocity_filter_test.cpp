// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/velocity_filter.hpp"

#include <gtest/gtest.h>

namespace dynamic_icp::ego_motion {
namespace {

Scan scan_of(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& doppler) {
  RawScan raw;
  raw.points = points;
  raw.doppler = doppler;
  return Scan::from_raw(raw);
}

TEST(VelocityFilter, TakesTheSensorsOwnMotionOut) {
  // Driving at 10 m/s along x: what stands ahead comes nearer at 10, a car ahead at the same speed stays.
  const Eigen::Vector3d v(10.0, 0.0, 0.0);
  const Scan scan = scan_of({{20, 0, 0}, {20, 1e-9, 0}, {0, 5, 0}, {-3, 0, 0}}, {-10.0, 0.0, 0.0, 10.0});
  const std::vector<double> compensated = compensated_doppler(scan, v);
  EXPECT_NEAR(compensated[0], 0.0, 1e-12);
  EXPECT_NEAR(compensated[1], 10.0, 1e-8);
  EXPECT_NEAR(compensated[2], 0.0, 1e-12);
  EXPECT_NEAR(compensated[3], 0.0, 1e-12);
}

TEST(VelocityFilter, CompensatesTheMotionAtTheTimeOfEachPoint) {
  const Eigen::Vector3d v(10.0, 1.0, 0.0);
  const Eigen::Vector3d a(-4.0, 0.0, 2.0);
  RawScan raw;
  raw.points = {{20, 5, 1}, {20, 5, 1}, {-3, 8, 2}};
  raw.times = {0.0, 0.05, 0.1};
  EgoVelocity ego;
  ego.velocity_sensor = v;
  ego.acceleration_sensor = a;
  ego.reference_time_s = 0.05;
  ego.bias_mps = 0.3;
  for (std::size_t i = 0; i < 3; ++i) {  // static points
    raw.doppler.push_back(0.3 - raw.points[i].normalized().dot(v + (raw.times[i] - 0.05) * a));
  }
  raw.doppler[1] += 7.0;  // but one
  std::vector<double> compensated;
  compensated_doppler(Scan::from_raw(raw), ego, Workers(1), compensated);
  EXPECT_NEAR(compensated[0], 0.0, 1e-12);
  EXPECT_NEAR(compensated[1], 7.0, 1e-12);
  EXPECT_NEAR(compensated[2], 0.0, 1e-12);
}

TEST(VelocityFilter, ThresholdGrowsWithTheDistance) {
  // tau(100 m) = 0.35 + 0.005 * 100 = 0.85 m/s, tau(10 m) = 0.40 m/s.
  const Scan scan = scan_of({{100, 0, 0}, {100, 0, 0}, {10, 0, 0}, {10, 0, 0}, {0, 10, 0}}, {0, 0, 0, 0, 0});
  const std::vector<double> compensated = {0.84, -0.86, 0.39, 0.41, -0.41};
  EXPECT_EQ(dynamic_mask(scan, compensated, {}), (std::vector<std::uint8_t>{0, 1, 0, 1, 1}));
}

TEST(VelocityFilter, SwitchedOffEverythingIsStatic) {
  const Scan scan = scan_of({{10, 0, 0}}, {0});
  EXPECT_EQ(dynamic_mask(scan, {50.0}, {.enabled = false}), std::vector<std::uint8_t>{0});
}

TEST(VelocityFilter, OfNothingIsNothing) {
  EXPECT_TRUE(compensated_doppler(Scan{}, {1, 2, 3}).empty());
  EXPECT_TRUE(dynamic_mask(Scan{}, {}, {}).empty());
}

}  // namespace
}  // namespace dynamic_icp::ego_motion
