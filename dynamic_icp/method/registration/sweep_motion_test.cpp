// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/registration/sweep_motion.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::registration {
namespace {

using Eigen::Vector3d;

SweepMotion turning_drive() {
  SweepMotion sweep;
  sweep.omega = {0.10, -0.20, 0.60};
  sweep.alpha = {-0.5, 0.8, 0.3};
  sweep.velocity = {20.0, -0.5, 0.2};
  sweep.acceleration = {2.0, -1.0, 0.5};
  return sweep;
}

/// The pose at tau by many small steps of T' = T [omega(tau); v(tau)].
Eigen::Isometry3d integrated(const SweepMotion& sweep, double tau) {
  constexpr int kSteps = 20000;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  const double dt = tau / kSteps;
  for (int k = 0; k < kSteps; ++k) {
    const double middle = (k + 0.5) * dt;
    Vector6d twist;
    twist << sweep.omega + middle * sweep.alpha, sweep.velocity_at(middle);
    T = T * exp_se3(dt * twist);
  }
  return T;
}

TEST(SweepMotion, IsTheIntegralOfItsRates) {
  const SweepMotion sweep = turning_drive();
  for (const double tau : {0.0, 0.02, 0.1, -0.05}) {
    const Eigen::Isometry3d expected = integrated(sweep, tau);
    const Eigen::Isometry3d pose = sweep.pose(tau);
    EXPECT_LT((pose.translation() - expected.translation()).norm(), 2e-5) << tau;
    // Turns that follow each other do not add up exactly: omega x alpha tau^3 / 12.
    EXPECT_LT(rotation_angle(pose.linear().transpose() * expected.linear()), 6e-5) << tau;
  }
}

TEST(SweepMotion, OfASteadyTurnIsAnArc) {
  SweepMotion sweep;
  sweep.omega = {0.0, 0.0, 0.5};
  sweep.velocity = {10.0, 0.0, 0.0};
  const double tau = 0.1;
  const Eigen::Isometry3d pose = sweep.pose(tau);
  EXPECT_NEAR(pose.translation().x(), 10.0 / 0.5 * std::sin(0.05), 1e-8);
  EXPECT_NEAR(pose.translation().y(), 10.0 / 0.5 * (1.0 - std::cos(0.05)), 1e-6);
  EXPECT_NEAR(rotation_angle(pose.linear()), 0.05, 1e-12);
}

TEST(SweepUndone, AgreesWithThePoseAtEachTime) {
  const SweepMotion sweep = turning_drive();
  std::vector<double> times;
  for (int k = 0; k <= 1000; ++k) {
    times.push_back(0.003 + 1e-4 * k);
  }
  const SweepUndone undone(sweep, {0.0, times.back()});
  const Vector3d point(40.0, -25.0, 3.0);
  for (const double tau : times) {
    EXPECT_LT((undone.at_stamp(point, tau) - sweep.pose(tau) * point).norm(), 5e-5) << tau;
  }
}

TEST(UndoSweep, LeavesScansWithoutTimesAlone) {
  RawScan raw;
  raw.points = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  raw.doppler = {0.1, 0.2};
  const Scan scan = Scan::from_raw(raw);
  EXPECT_EQ(undo_sweep(scan, turning_drive(), Workers(1)).points(), scan.points());
}

TEST(UndoSweep, HandlesEqualTimesAndKeepsMeasurements) {
  RawScan raw;
  raw.points = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  raw.doppler = {0.1, 0.2};
  raw.times = {0.05, 0.05};
  const Scan scan = Scan::from_raw(raw);
  const Scan undone = undo_sweep(scan, turning_drive(), Workers(1));
  for (std::size_t row = 0; row < 2; ++row) {
    EXPECT_LT((undone.points()[row] - turning_drive().pose(0.05) * scan.points()[row]).norm(), 1e-12);
  }
  EXPECT_EQ(undone.directions(), scan.directions());
  EXPECT_EQ(undone.doppler(), scan.doppler());
}

}  // namespace
}  // namespace dynamic_icp::registration
