// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/drive.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/tools/world/spring_sway.hpp"
#include "dynamic_icp/tools/world/terrain.hpp"

namespace dynamic_icp::world {
namespace {

std::shared_ptr<const Route> winding_route() {
  std::vector<RoutePiece> pieces = {{15.0, 0.0, 0.0}};
  for (const double angle : {0.5 * std::numbers::pi, -2.0}) {
    const auto bend = turn(angle, 11.0, 6.0);
    pieces.insert(pieces.end(), bend.begin(), bend.end());
  }
  return std::make_shared<const Route>(pieces);
}

/// The twist must be the time derivative of the pose: central differences of position and rotation.
void expect_twist_is_derivative(const Trajectory& trajectory, double t) {
  const double h = 1e-4;
  const MotionState before = trajectory(t - h);
  const MotionState after = trajectory(t + h);
  const MotionState now = trajectory(t);
  const Eigen::Vector3d velocity = (after.T_world_body.translation() - before.T_world_body.translation()) / (2.0 * h);
  const Eigen::Vector3d omega =
      log_so3(after.T_world_body.linear() * before.T_world_body.linear().transpose()) / (2.0 * h);
  EXPECT_LT((velocity - now.velocity_world).norm(), 2e-6) << t;
  EXPECT_LT((omega - now.angular_velocity_world).norm(), 2e-6) << t;
}

TEST(Drive, TwistIsTheDerivativeOfThePose) {
  const SpeedProfile speed({{0.0, 6.0}, {3.0, 9.0}, {6.0, 2.0}});
  const SwayFunction sway = spring_sway(5.0, RandomSource(3));
  for (const RouteFollowing& following :
       {RouteFollowing{2.0, 0.0, false}, RouteFollowing{2.0, -3.0, false}, RouteFollowing{45.0, 3.0, true}}) {
    for (double t = 0.0; t < 8.0; t += 0.117) {
      expect_twist_is_derivative(drive(winding_route(), speed, following), t);
      expect_twist_is_derivative(drive(winding_route(), speed, following, sway), t);
    }
  }
}

TEST(Drive, MountedTwistIsTheDerivativeOfTheMountedPose) {
  Eigen::Isometry3d T_vehicle_sensor = Eigen::Isometry3d::Identity();
  T_vehicle_sensor.rotate(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1.0, -2.0, 3.0).normalized()));
  T_vehicle_sensor.pretranslate(Eigen::Vector3d(1.5, 0.2, 1.9));
  const Trajectory vehicle = drive(winding_route(), SpeedProfile(8.0), {}, spring_sway(5.0, RandomSource(4)));
  const Trajectory sensor = [&](double t) { return mounted(vehicle(t), T_vehicle_sensor); };
  for (double t = 0.0; t < 6.0; t += 0.117) {
    expect_twist_is_derivative(sensor, t);
  }
}

TEST(Drive, TwistIsTheDerivativeOfThePoseOnRoughGround) {
  const Terrain terrain(1.5, RandomSource(5));
  const auto on_ground = [&](double, const PlanarState& planar) { return terrain.sway(planar); };
  const Trajectory vehicle = drive(winding_route(), SpeedProfile({{0.0, 6.0}, {3.0, 9.0}}), {}, on_ground);
  for (double t = 0.0; t < 6.0; t += 0.117) {
    expect_twist_is_derivative(vehicle, t);
    const MotionState state = vehicle(t);
    EXPECT_NEAR(state.T_world_body.translation().z(), terrain.height_m(state.T_world_body.translation().head<2>()),
                1e-12);
    // The forward axis follows the ground: a step along it stays on the ground to second order.
    const Eigen::Vector3d ahead = state.T_world_body * Eigen::Vector3d(0.01, 0.0, 0.0);
    EXPECT_NEAR(ahead.z(), terrain.height_m(ahead.head<2>()), 1e-5);
  }
}

TEST(Drive, CarsFaceTheWayTheyDrive) {
  for (const bool against : {false, true}) {
    const Trajectory car = drive(winding_route(), SpeedProfile(8.0), {40.0, 2.0, against});
    for (double t = 0.0; t < 4.0; t += 0.3) {
      const MotionState state = car(t);
      const Eigen::Vector3d forward = state.T_world_body.linear().col(0);
      EXPECT_NEAR(forward.dot(state.velocity_world), state.velocity_world.norm(), 1e-9);
    }
  }
}

TEST(Drive, LaneKeepsItsDistanceToTheRoute) {
  const auto route = winding_route();
  const Trajectory car = drive(route, SpeedProfile(8.0), {0.0, -3.0, false});
  for (double t = 0.0; t < 6.0; t += 0.3) {
    const RoutePoint point = route->at(8.0 * t);
    const Eigen::Vector2d right(std::sin(point.heading_rad), -std::cos(point.heading_rad));
    EXPECT_LT((car(t).T_world_body.translation().head<2>() - point.position - 3.0 * right).norm(), 1e-9);
  }
}

TEST(Stand, DoesNotMove) {
  const Eigen::Isometry3d T(Eigen::Translation3d(1.0, 2.0, 3.0));
  const MotionState state = stand(T)(5.0);
  EXPECT_TRUE(state.T_world_body.isApprox(T));
  EXPECT_TRUE(state.velocity_world.isZero(0.0));
  EXPECT_TRUE(state.angular_velocity_world.isZero(0.0));
}

TEST(MotionState, PointVelocityOfASpinningBody) {
  MotionState body;
  body.T_world_body.translation() << 1.0, 0.0, 0.0;
  body.velocity_world << 0.0, 2.0, 0.0;
  body.angular_velocity_world << 0.0, 0.0, 3.0;
  // 2 m ahead of the centre: 3 rad/s x 2 m to the left on top of the motion of the centre.
  EXPECT_TRUE(point_velocity(body, {3.0, 0.0, 0.0}).isApprox(Eigen::Vector3d(0.0, 8.0, 0.0)));
}

}  // namespace
}  // namespace dynamic_icp::world
