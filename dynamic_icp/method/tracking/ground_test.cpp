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

TEST(GroundFilter, TheFirstPlaneIsTakenAsItIs) {
  const Vector3d normal = exp_so3({0.1, -0.05, 0.0}).col(2);
  GroundFilter filter;
  const Ground ground = filter.update(normal, -1.7, {0, 0, 0});
  EXPECT_LT(angle_between(ground.up(), normal), 1e-9);
  ASSERT_TRUE(ground.offset_m);
  EXPECT_NEAR(*ground.offset_m, -1.7, 1e-12);
  expect_rotation(ground.level);
}

TEST(GroundFilter, FollowsARoadThatClimbs) {
  const Vector3d normal = exp_so3({0.0, -0.12, 0.0}).col(2);
  const Vector3d sensor(40.0, -30.0, 5.0);
  const double offset = normal.dot(sensor) - 1.8;
  GroundFilter filter;
  for (int scan = 0; scan < 20; ++scan) {
    filter.update(Vector3d::UnitZ(), sensor.z() - 1.8, sensor);
  }
  for (int scan = 0; scan < 20; ++scan) {
    filter.update(normal, offset, sensor);
    expect_rotation(filter.ground().level);
  }
  EXPECT_LT(angle_between(filter.ground().up(), normal), 1e-6);
  EXPECT_NEAR(*filter.ground().offset_m, offset, 1e-6);
}

TEST(GroundFilter, AFewOtherPlanesDoNotMoveIt) {
  // Two scans in five show a plane that leans on guard rails, from the first scan on.
  const Vector3d wrong = exp_so3({0.2, 0.0, 0.0}).col(2);
  GroundFilter filter;
  for (int scan = 0; scan < 30; ++scan) {
    const bool is_wrong = scan % 5 == 0 || scan % 5 == 2;
    filter.update(is_wrong ? wrong : Vector3d::UnitZ(), is_wrong ? -4.3 : -2.0, {0, 0, 0});
    if (scan > 8) {
      EXPECT_LT(angle_between(filter.ground().up(), Vector3d::UnitZ()), 1e-9) << "scan " << scan;
      EXPECT_NEAR(*filter.ground().offset_m, -2.0, 1e-9) << "scan " << scan;
    }
  }
}

TEST(GroundFilter, OfPlanesThatScansAlternateBetweenTheNearestIsTheGround) {
  // Most scans show an embankment beside the road: all is above that plane too, but it is farther from the sensor.
  const Vector3d embankment = exp_so3({0.2, 0.0, 0.0}).col(2);
  GroundFilter filter;
  for (int scan = 0; scan < 30; ++scan) {
    const bool is_ground = scan % 3 == 0;
    filter.update(is_ground ? Vector3d(Vector3d::UnitZ()) : embankment, is_ground ? -2.0 : -4.2, {0, 0, 0});
    if (scan > 2) {  // of three a quarter is none
      EXPECT_LT(angle_between(filter.ground().up(), Vector3d::UnitZ()), 1e-9) << "scan " << scan;
      EXPECT_NEAR(*filter.ground().offset_m, -2.0, 1e-9) << "scan " << scan;
    }
  }
}

TEST(GroundFilter, AWallIsNoGround) {
  GroundFilter filter;
  const Ground before = filter.update(exp_so3({0.05, 0.02, 0.0}).col(2), -1.8, {0, 0, 0});
  for (const Vector3d& normal : {Vector3d(1, 0, 0), Vector3d(0.3, -0.8, 0.2).normalized().eval(), Vector3d(0, 0, -1)}) {
    const Ground after = filter.update(normal, -3.0, {0, 0, 0});
    EXPECT_EQ(after.level, before.level);
    EXPECT_EQ(after.offset_m, before.offset_m);
  }
}

TEST(GroundFilter, HeadingsStayWhatTheyAre) {
  // The axes turn about no part of the normal: a heading moves by no more than the slope makes of it.
  GroundFilter filter;
  for (int scan = 0; scan < 200; ++scan) {
    // Round and round: small turns about the vertical would add up.
    const double phase = 0.3 * scan;
    filter.update(exp_so3({0.05 * std::cos(phase), 0.05 * std::sin(phase), 0.0}).col(2), -1.8, {0, 0, 0});
  }
  for (int scan = 0; scan < 20; ++scan) {
    filter.update(Vector3d::UnitZ(), -1.8, {0, 0, 0});
  }
  EXPECT_NEAR(std::atan2(filter.ground().level(1, 0), filter.ground().level(0, 0)), 0.0, 0.1)
      << "nine rounds about the vertical enclose 0.07 rad";
}

}  // namespace
}  // namespace dynamic_icp::tracking
