// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/ground.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

double angle_between(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

void expect_rotation(const Matrix3d& R) {
  EXPECT_TRUE((R.transpose() * R).isApprox(Matrix3d::Identity(), 1e-12));
  EXPECT_NEAR(R.determinant(), 1.0, 1e-12);
}

TEST(Ground, TheFirstPlaneIsTakenAsItIs) {
  const Vector3d normal = exp_so3({0.1, -0.05, 0.0}).col(2);
  const Ground ground = updated_ground({}, normal, -1.7, {0, 0, 0});
  EXPECT_LT(angle_between(ground.up(), normal), 1e-9);
  ASSERT_TRUE(ground.offset_m);
  EXPECT_NEAR(*ground.offset_m, -1.7, 1e-12);
  expect_rotation(ground.level);
}

TEST(Ground, FollowsATiltedPlane) {
  // A road that begins to climb: the direction follows over some scans, never beyond, and the road is always at once
  // where it is below the sensor.
  const Vector3d normal = exp_so3({0.0, -0.12, 0.0}).col(2);
  const Vector3d sensor(40.0, -30.0, 5.0);
  const double offset = normal.dot(sensor) - 1.8;
  const Vector3d foot = sensor - 1.8 * normal;
  Ground ground{Matrix3d::Identity(), 0.0};
  double before = angle_between(ground.up(), normal);
  for (int scan = 0; scan < 40; ++scan) {
    ground = updated_ground(ground, normal, offset, sensor);
    const double angle = angle_between(ground.up(), normal);
    EXPECT_LT(angle, before) << "scan " << scan;
    before = angle;
    ASSERT_TRUE(ground.offset_m);
    EXPECT_NEAR(ground.up().dot(foot), *ground.offset_m, 1e-9) << "scan " << scan;
    expect_rotation(ground.level);
  }
  EXPECT_LT(before, 1e-3);
  EXPECT_NEAR(*ground.offset_m, offset, 0.05);
}

TEST(Ground, OneBadPlaneTiltsItLittle) {
  const Ground ground{Matrix3d::Identity(), -1.8};
  const Vector3d normal = exp_so3({0.2, 0.0, 0.0}).col(2);
  EXPECT_LT(angle_between(updated_ground(ground, normal, -1.8, {0, 0, 0}).up(), Vector3d::UnitZ()), 0.1);
}

TEST(Ground, AWallIsNoGround) {
  const Ground ground{exp_so3({0.05, 0.02, 0.4}), -1.8};
  for (const Vector3d& normal : {Vector3d(1, 0, 0), Vector3d(0.3, -0.8, 0.2).normalized().eval(), Vector3d(0, 0, -1)}) {
    const Ground after = updated_ground(ground, normal, -3.0, {0, 0, 0});
    EXPECT_EQ(after.level, ground.level);
    EXPECT_EQ(after.offset_m, ground.offset_m);
  }
}

TEST(Ground, HeadingsStayWhatTheyAre) {
  // The axes turn about no part of the normal: a heading moves by no more than the slope makes of it.
  Ground ground{exp_so3({0.0, 0.0, 0.8}), -1.8};
  for (int scan = 0; scan < 200; ++scan) {
    // Round and round: small turns about the vertical would add up.
    const double phase = 0.3 * scan;
    const Vector3d normal = exp_so3({0.05 * std::cos(phase), 0.05 * std::sin(phase), 0.0}).col(2);
    ground = updated_ground(ground, normal, -1.8, {0, 0, 0});
  }
  for (int scan = 0; scan < 50; ++scan) {
    ground = updated_ground(ground, Vector3d::UnitZ(), -1.8, {0, 0, 0});
  }
  EXPECT_NEAR(std::atan2(ground.level(1, 0), ground.level(0, 0)), 0.8, 0.05);
  // One step: the turn is about an axis in the ground.
  const Vector3d normal = exp_so3({0.1, 0.05, 0.0}).col(2);
  const Ground next = updated_ground(ground, normal, -1.8, {0, 0, 0});
  EXPECT_NEAR(log_so3(next.level * ground.level.transpose()).dot(ground.up()), 0.0, 1e-9);
}

}  // namespace
}  // namespace dynamic_icp::tracking
