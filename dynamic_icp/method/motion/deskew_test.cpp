// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/motion/deskew.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::motion {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Scan scan_of(const std::vector<Vector3d>& points, const std::vector<double>& times) {
  RawScan raw;
  raw.points = points;
  raw.doppler.assign(points.size(), 1.0);
  raw.times = times;
  return Scan::from_raw(raw);
}

Isometry3d translation(double x, double y, double z) { return Isometry3d(Eigen::Translation3d(x, y, z)); }

SweepMotion turning_drive() {
  SweepMotion sweep;
  sweep.omega = {0.10, -0.20, 0.60};
  sweep.alpha = {-0.5, 0.8, 0.3};
  sweep.velocity = {20.0, -0.5, 0.2};
  sweep.acceleration = {2.0, -1.0, 0.5};
  return sweep;
}

/// The pose at tau by many small steps of T' = T [omega(tau); v(tau)].
TEST(DeskewToMiddle, MovesPointsAlongByTheirShareOfTheSweep) {
  // 2 m forward during the sweep: at its begin the sensor stood 1 m behind the middle, at its end 1 m ahead.
  const Scan moved = deskew_to_middle(
      scan_of({{10, 0, 0}, {10, 0, 0}, {10, 5, 0}, {10, 0, 0}}, {0.02, 0.12, 0.07, 0.045}), translation(2.0, 0.0, 0.0));
  EXPECT_NEAR((moved.points()[0] - Vector3d(9.0, 0, 0)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((moved.points()[1] - Vector3d(11.0, 0, 0)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((moved.points()[2] - Vector3d(10.0, 5.0, 0)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((moved.points()[3] - Vector3d(9.5, 0, 0)).norm(), 0.0, 1e-14);
}

TEST(DeskewToMiddle, TurnsPointsByTheirShareOfTheSweep) {
  // A quarter turn to the left: the last point was measured 45 degrees further left than the middle of the sweep.
  Isometry3d quarter = Isometry3d::Identity();
  quarter.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const Scan moved = deskew_to_middle(scan_of({{1, 0, 0}, {1, 0, 0}}, {0.0, 0.1}), quarter);
  const double half = std::sqrt(0.5);
  EXPECT_NEAR((moved.points()[0] - Vector3d(half, -half, 0)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((moved.points()[1] - Vector3d(half, half, 0)).norm(), 0.0, 1e-14);
}

TEST(DeskewToMiddle, BringsAWallSeenInMotionBackOntoTheWall) {
  Vector6d twist;
  twist << 0.02, -0.03, 0.3, 2.5, 0.4, -0.1;  // rad and m in one sweep
  const Vector3d normal = Vector3d(0.8, 0.5, 0.1).normalized();
  const Vector3d along = normal.unitOrthogonal();
  std::vector<Vector3d> measured;
  std::vector<double> times;
  for (int i = 0; i <= 100; ++i) {
    const double s = 0.01 * i;
    const Vector3d on_wall = 12.0 * normal + 0.3 * (i - 50) * along + 2.0 * std::sin(i) * normal.cross(along);
    measured.push_back(exp_se3((s - 0.5) * twist).inverse() * on_wall);
    times.push_back(0.1 * s);
  }
  const Scan raw = scan_of(measured, times);
  const Scan moved = deskew_to_middle(raw, exp_se3(twist));
  double worst_before = 0.0;
  for (std::size_t row = 0; row < moved.size(); ++row) {
    EXPECT_NEAR(normal.dot(moved.points()[row]), 12.0, 1e-9) << row;
    worst_before = std::max(worst_before, std::abs(normal.dot(raw.points()[row]) - 12.0));
  }
  EXPECT_GT(worst_before, 1.0) << "there was something to undo";
  EXPECT_EQ(moved.directions(), raw.directions());
  EXPECT_EQ(moved.doppler(), raw.doppler());
  EXPECT_EQ(moved.times(), raw.times());
}

TEST(DeskewToMiddle, LeavesScansAloneThatSayNothingOfTime) {
  const std::vector<Vector3d> points = {{1, 2, 3}, {4, 5, 6}};
  EXPECT_EQ(deskew_to_middle(scan_of(points, {}), translation(2, 0, 0)).points(), points);
  EXPECT_EQ(deskew_to_middle(scan_of(points, {0.05, 0.05}), translation(2, 0, 0)).points(), points);
  EXPECT_TRUE(deskew_to_middle(Scan{}, translation(2, 0, 0)).empty());
}

TEST(Deskewer, AgreesWithThePoseAtEachTime) {
  const SweepMotion sweep = turning_drive();
  std::vector<double> times;
  for (int k = 0; k <= 1000; ++k) {
    times.push_back(0.003 + 1e-4 * k);
  }
  const Deskewer deskewed(sweep, {0.0, times.back()});
  const Vector3d point(40.0, -25.0, 3.0);
  for (const double tau : times) {
    EXPECT_LT((deskewed.at_stamp(point, tau) - sweep.pose(tau) * point).norm(), 5e-5) << tau;
  }
}

TEST(Deskew, LeavesScansWithoutTimesAlone) {
  RawScan raw;
  raw.points = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  raw.doppler = {0.1, 0.2};
  const Scan scan = Scan::from_raw(raw);
  EXPECT_EQ(deskew(scan, turning_drive(), Workers(1)).points(), scan.points());
}

TEST(Deskew, HandlesEqualTimesAndKeepsMeasurements) {
  RawScan raw;
  raw.points = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  raw.doppler = {0.1, 0.2};
  raw.times = {0.05, 0.05};
  const Scan scan = Scan::from_raw(raw);
  const Scan deskewed = deskew(scan, turning_drive(), Workers(1));
  for (std::size_t row = 0; row < 2; ++row) {
    EXPECT_LT((deskewed.points()[row] - turning_drive().pose(0.05) * scan.points()[row]).norm(), 1e-12);
  }
  EXPECT_EQ(deskewed.directions(), scan.directions());
  EXPECT_EQ(deskewed.doppler(), scan.doppler());
}

TEST(Deskew, TakesTimesThatCannotBeAsTheNearestThatCan) {
  RawScan raw;
  raw.points = {{10.0, 0.0, 0.0}, {10.0, 1.0, 0.0}, {10.0, 2.0, 0.0}};
  raw.doppler = {0.0, 0.0, 0.0};
  raw.times = {-0.3, 0.1, 0.7};
  const Scan scan = Scan::from_raw(raw);
  const SweepMotion sweep = turning_drive();
  const Scan deskewed = deskew(scan, sweep, {0.0, 0.2}, Workers(1));
  const double counted[] = {0.0, 0.1, 0.2};
  for (std::size_t row = 0; row < 3; ++row) {
    EXPECT_LT((deskewed.points()[row] - sweep.pose(counted[row]) * scan.points()[row]).norm(), 5e-5) << row;
  }
}

}  // namespace
}  // namespace dynamic_icp::motion
