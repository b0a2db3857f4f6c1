// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/drive.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace dynamic_icp::world {

PlanarState planar_state(const Route& route, const SpeedProfile& speed, const RouteFollowing& following,
                         double time_s) {
  const double sign = following.against ? -1.0 : 1.0;
  const RoutePoint point = route.at(following.start_m + sign * speed.distance_m(time_s));
  const double s_dot = sign * speed.speed_mps(time_s);
  const Eigen::Vector2d tangent(std::cos(point.heading_rad), std::sin(point.heading_rad));
  const Eigen::Vector2d left(-tangent.y(), tangent.x());
  PlanarState state;
  state.position = point.position + following.lateral_m * left;
  state.velocity = s_dot * (1.0 - point.curvature * following.lateral_m) * tangent;
  state.heading_rad = point.heading_rad + (following.against ? std::numbers::pi : 0.0);
  state.yaw_rate_rps = point.curvature * s_dot;
  return state;
}

MotionState lift(const PlanarState& planar, const Sway& sway) {
  const Eigen::AngleAxisd yaw(planar.heading_rad, Eigen::Vector3d::UnitZ());
  const Eigen::AngleAxisd pitch(sway.pitch_rad, Eigen::Vector3d::UnitY());
  const Eigen::AngleAxisd roll(sway.roll_rad, Eigen::Vector3d::UnitX());
  MotionState state;
  state.T_world_body.linear() = (yaw * pitch * roll).toRotationMatrix();
  state.T_world_body.translation() << planar.position, sway.heave_m;
  state.velocity_world << planar.velocity, sway.heave_mps;
  // Each rate turns about its axis as the rotations to the left of it have moved it.
  state.angular_velocity_world = planar.yaw_rate_rps * Eigen::Vector3d::UnitZ() +
                                 yaw * (sway.pitch_rps * Eigen::Vector3d::UnitY()) +
                                 yaw * (pitch * (sway.roll_rps * Eigen::Vector3d::UnitX()));
  return state;
}

Trajectory drive(std::shared_ptr<const Route> route, SpeedProfile speed, RouteFollowing following, SwayFunction sway) {
  return [route = std::move(route), speed = std::move(speed), following, sway = std::move(sway)](double time_s) {
    const PlanarState planar = planar_state(*route, speed, following, time_s);
    return lift(planar, sway ? sway(time_s, planar) : Sway{});
  };
}

Trajectory stand(const Eigen::Isometry3d& T_world_body) {
  MotionState state;
  state.T_world_body = T_world_body;
  return [state](double) { return state; };
}

}  // namespace dynamic_icp::world
