// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/sensor_motion.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

TEST(SensorMotion, GoesOnEvenly) {
  // 10 m/s along the world's x axis, turning by 0.5 rad/s.
  Eigen::Isometry3d now = Eigen::Isometry3d::Identity();
  now.linear() = exp_so3({0, 0, 0.35});
  now.translation() = Vector3d(1, 0, 0);
  const SensorMotion motion = motion_at(now, {0, 0, 0.5}, now.linear().transpose() * Vector3d(10, 0, 0));
  EXPECT_TRUE(motion.position(0.1).isApprox(Vector3d(2, 0, 0), 1e-12));
  const Vector3d u = Vector3d(1, 0.2, 0.1).normalized();
  EXPECT_TRUE(motion.direction_world(u, 0.1).isApprox(exp_so3({0, 0, 0.4}) * u, 1e-4)) << "second order in 0.05 rad";
  EXPECT_TRUE(motion.direction_world(u, 0.0).isApprox(exp_so3({0, 0, 0.35}) * u, 1e-12));
  const Vector3d seen(20, -3, 1);
  EXPECT_TRUE(motion.point_world(seen, 0.1).isApprox(Vector3d(2, 0, 0) + exp_so3({0, 0, 0.4}) * seen, 1e-4));
}

TEST(SensorMotion, AtRestNothingChanges) {
  const SensorMotion motion;
  EXPECT_EQ(motion.position(0.1), Vector3d::Zero());
  EXPECT_EQ(motion.direction_world(Vector3d::UnitX(), 0.1), Vector3d::UnitX());
}

}  // namespace
}  // namespace dynamic_icp::tracking
