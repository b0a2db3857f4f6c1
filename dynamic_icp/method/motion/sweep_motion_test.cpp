// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/motion/sweep_motion.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::motion {
namespace {

using Eigen::Vector3d;

SweepMotion turning_sweep() {
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
  const SweepMotion sweep = turning_sweep();
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

}  // namespace
}  // namespace dynamic_icp::motion
