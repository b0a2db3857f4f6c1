// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/towing.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "dynamic_icp/tools/world/drive.hpp"

namespace dynamic_icp::world {
namespace {

using Eigen::Vector3d;

constexpr Hitch kSemitrailer = {-1.5, 5.3, -3.7};
constexpr double kRadius_m = 16.0;
constexpr double kSpeed_mps = 6.0;

/// Straight on, then round and round to the left.
Trajectory circling(double straight_m) {
  std::vector<RoutePiece> pieces = {{straight_m, 0.0, 0.0}, {400.0, 1.0 / kRadius_m, 1.0 / kRadius_m}};
  return drive(std::make_shared<const Route>(pieces), SpeedProfile(kSpeed_mps), {});
}

double heading(const MotionState& state) {
  const Vector3d ahead = state.T_world_body.linear().col(0);
  return std::atan2(ahead.y(), ahead.x());
}

TEST(Towing, follows_straight_behind) {
  const Trajectory vehicle = circling(1000.0);
  const MotionState trailer = tow(vehicle, kSemitrailer, 10.0)(7.0);
  EXPECT_NEAR(heading(trailer), 0.0, 1e-12);
  EXPECT_NEAR(trailer.T_world_body.translation().x(), 7.0 * kSpeed_mps - 1.5 - 5.3, 1e-9);
  EXPECT_NEAR(trailer.velocity_world.x(), kSpeed_mps, 1e-9);
}

TEST(Towing, twist_is_the_derivative_of_the_pose) {
  const Trajectory vehicle = circling(10.0);
  const Trajectory trailer = tow(vehicle, kSemitrailer, 10.0);
  constexpr double kStep = 1e-5;
  for (const double time_s : {0.5, 1.9, 2.513, 4.0, 7.7}) {
    const MotionState before = trailer(time_s - kStep);
    const MotionState after = trailer(time_s + kStep);
    const MotionState now = trailer(time_s);
    const Vector3d velocity = (after.T_world_body.translation() - before.T_world_body.translation()) / (2.0 * kStep);
    EXPECT_LT((velocity - now.velocity_world).norm(), 1e-6) << time_s;
    EXPECT_NEAR((heading(after) - heading(before)) / (2.0 * kStep), now.angular_velocity_world.z(), 1e-6) << time_s;
  }
}

TEST(Towing, joint_stays_together_and_axle_does_not_slip) {
  const Trajectory vehicle = circling(10.0);
  const Trajectory trailer = tow(vehicle, kSemitrailer, 10.0);
  for (const double time_s : {0.0, 2.3, 3.1, 6.0, 9.9}) {
    const MotionState towing = vehicle(time_s);
    const MotionState towed = trailer(time_s);
    const Vector3d joint = towing.T_world_body * Vector3d(kSemitrailer.on_vehicle_m, 0.0, 0.0);
    EXPECT_LT((joint - towed.T_world_body * Vector3d(kSemitrailer.on_trailer_m, 0.0, 0.0)).norm(), 1e-12) << time_s;
    const Vector3d axle = towed.T_world_body * Vector3d(kSemitrailer.axle_m, 0.0, 0.0);
    EXPECT_NEAR(point_velocity(towed, axle).dot(towed.T_world_body.linear().col(1)), 0.0, 1e-6) << time_s;
  }
}

/// On a circle the axle ends on a circle of radius sqrt(R_joint^2 - L^2) about the same centre.
TEST(Towing, cuts_the_corner_as_a_tractrix_does) {
  const Trajectory trailer = tow(circling(10.0), kSemitrailer, 40.0);
  const Vector3d centre(10.0, kRadius_m, 0.0);
  const double joint_squared = kRadius_m * kRadius_m + kSemitrailer.on_vehicle_m * kSemitrailer.on_vehicle_m;
  const double to_axle = kSemitrailer.on_trailer_m - kSemitrailer.axle_m;
  const MotionState late = trailer(40.0);
  const Vector3d axle = late.T_world_body * Vector3d(kSemitrailer.axle_m, 0.0, 0.0);
  EXPECT_NEAR((axle - centre).norm(), std::sqrt(joint_squared - to_axle * to_axle), 1e-6);
  EXPECT_NEAR(late.angular_velocity_world.z(), kSpeed_mps / kRadius_m, 1e-6);
}

TEST(Towing, refuses_an_axle_ahead_of_the_joint) {
  EXPECT_THROW(tow(circling(10.0), {-1.5, 1.0, 2.0}, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace dynamic_icp::world
