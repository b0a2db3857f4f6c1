// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/rig_origin.hpp"

#include <gtest/gtest.h>

namespace dynamic_icp::odometry {
namespace {

const Eigen::Vector3d kMiddle(1.2, -0.3, 2.0);

Eigen::Isometry3d translation(const Eigen::Vector3d& t) { return Eigen::Isometry3d(Eigen::Translation3d(t)); }

TEST(RigOrigin, PosesAreThoseOfTheOrigin) {
  // Two poses of the origin of a rigid body, and those of its middle.
  Vector6d xi;
  xi << 0.1, -0.2, 0.3, 4.0, 5.0, -6.0;
  const Eigen::Isometry3d T_world_origin = exp_se3(xi);
  Frame frame;
  frame.T_world_sensor = translation(-kMiddle) * T_world_origin * translation(kMiddle);
  frame.T_target_source = frame.T_world_sensor.inverse();
  const Frame moved = seen_from_origin(frame, kMiddle);
  EXPECT_TRUE(moved.T_world_sensor.isApprox(T_world_origin, 1e-12));
  EXPECT_TRUE(moved.T_target_source.isApprox(T_world_origin.inverse(), 1e-12));
}

TEST(RigOrigin, CovariancesFollowTheAdjoint) {
  Frame frame;
  frame.T_target_source = exp_se3((Vector6d() << 0.02, 0.01, -0.3, 1.0, 0.1, 0.0).finished());
  frame.alignment.T_target_source = frame.T_target_source;
  // One direction of error: its perturbation, seen from the origin, must be the direction of the moved covariance.
  Vector6d error;
  error << 1e-6, -2e-6, 3e-6, 4e-6, 1e-6, -5e-6;
  frame.alignment.covariance = error * error.transpose();
  const Frame moved = seen_from_origin(frame, kMiddle);
  Frame wrong = frame;
  wrong.T_target_source = exp_se3(error) * frame.T_target_source;
  const Frame moved_wrong = seen_from_origin(wrong, kMiddle);
  const Vector6d seen = log_se3(moved_wrong.T_target_source * moved.T_target_source.inverse());
  EXPECT_LT((moved.alignment.covariance.value() - seen * seen.transpose()).norm(), 1e-4 * seen.squaredNorm());
}

TEST(RigOrigin, TheVelocityHasTheLeverArm) {
  Frame frame;
  frame.twist.emplace();
  frame.twist->angular = Eigen::Vector3d(0.0, 0.0, 0.5);
  frame.twist->linear = Eigen::Vector3d(10.0, 0.0, 0.0);
  frame.ego.velocity_sensor = frame.twist->linear;
  const Frame moved = seen_from_origin(frame, {2.0, 0.0, 0.0});
  // The origin, 2 m behind the middle, moves to the right of it in a bend to the left.
  EXPECT_TRUE(moved.twist->linear.isApprox(Eigen::Vector3d(10.0, -1.0, 0.0), 1e-12));
  EXPECT_EQ(moved.ego.velocity_sensor, moved.twist->linear);
}

TEST(RigOrigin, TheMiddleIsTheMeanOfTheSensors) {
  RawScan raw;
  raw.points = {{5.0, 0.0, 0.0}};
  raw.doppler = {0.0};
  raw.channels.sensor = {1};
  raw.mountings = {translation({1.0, 1.0, 0.0}), translation({2.0, -1.0, 2.0})};
  EXPECT_EQ(middle_of_sensors(Scan::from_raw(raw)), Eigen::Vector3d(1.5, 0.0, 1.0));
}

}  // namespace
}  // namespace dynamic_icp::odometry
