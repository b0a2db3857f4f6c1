// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/motion/twist.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "dynamic_icp/method/motion/sweep_motion.hpp"

namespace dynamic_icp::motion {
namespace {

using Eigen::Vector3d;

TEST(ConstantVelocity, ASteadyTurnIsAnArc) {
  const Eigen::Isometry3d T = motion_of(Vector3d(0.0, 0.0, 0.5), Vector3d(10.0, 0.0, 0.0), 0.4);
  EXPECT_NEAR(T.translation().x(), 20.0 * std::sin(0.2), 1e-12);
  EXPECT_NEAR(T.translation().y(), 20.0 * (1.0 - std::cos(0.2)), 1e-12);
  EXPECT_NEAR(rotation_angle(T.linear()), 0.2, 1e-12);
}

TEST(ConstantVelocity, BackAndForthAreInverse) {
  Vector6d twist;
  twist << 0.1, -0.2, 0.6, 12.0, -0.5, 0.3;
  EXPECT_TRUE((motion_of(twist, 0.3) * motion_of(twist, -0.3)).isApprox(Eigen::Isometry3d::Identity(), 1e-12));
  EXPECT_TRUE(mean_twist(motion_of(twist, 0.3), 0.3).isApprox(twist, 1e-12));
}

TEST(ConstantVelocity, IsThatOfASweep) {
  Vector6d twist;
  twist << 0.1, -0.2, 0.6, 12.0, -0.5, 0.3;
  const Eigen::Isometry3d T = motion_of(twist, 0.1);
  const Eigen::Isometry3d by_sweep = constant_sweep(twist).pose(0.1);
  EXPECT_LT((T.translation() - by_sweep.translation()).norm(), 1e-6) << "Simpson's rule";
  EXPECT_TRUE(T.linear().isApprox(by_sweep.linear(), 1e-12));
}

}  // namespace
}  // namespace dynamic_icp::motion
