// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>

#include <Eigen/Core>

#include "dynamic_icp/tools/world/motion_state.hpp"
#include "dynamic_icp/tools/world/route.hpp"
#include "dynamic_icp/tools/world/speed_profile.hpp"

namespace dynamic_icp::world {

/// A vehicle seen from above: position, heading and their time derivatives.
struct PlanarState {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< m
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< m/s
  double heading_rad = 0.0;                            ///< from x to y
  double yaw_rate_rps = 0.0;                           ///< rad/s
};

/// What a vehicle's body does on its springs or on rough ground, with the time derivatives.
struct Sway {
  double heave_m = 0.0;    ///< up
  double pitch_rad = 0.0;  ///< about the left axis: nose down is positive
  double roll_rad = 0.0;   ///< about the forward axis: right side down is positive
  double heave_mps = 0.0;
  double pitch_rps = 0.0;
  double roll_rps = 0.0;
};

/// Sway at a time, for a vehicle that is at the given planar state then.
using SwayFunction = std::function<Sway(double time_s, const PlanarState& planar)>;

/// How a vehicle follows a route.
struct RouteFollowing {
  double start_m = 0.0;    ///< arc length of the route at time 0
  double lateral_m = 0.0;  ///< to the left of the route, in the route's direction; below the radius of its bends
  bool against = false;    ///< drives towards smaller arc lengths
};

/// The planar state at a time; the velocity is the exact derivative of the position on curved lanes, too.
PlanarState planar_state(const Route& route, const SpeedProfile& speed, const RouteFollowing& following, double time_s);

/// The pose Rz(heading) Ry(pitch) Rx(roll) at (x, y, heave) with its exact twist.
MotionState lift(const PlanarState& planar, const Sway& sway);

/// The motion of a vehicle whose body frame lies on the road below its middle: x forward, y left, z up. An empty
/// `sway` keeps it level on z = 0.
Trajectory drive(std::shared_ptr<const Route> route, SpeedProfile speed, RouteFollowing following,
                 SwayFunction sway = {});

/// The motion of something at rest.
Trajectory stand(const Eigen::Isometry3d& T_world_body);

}  // namespace dynamic_icp::world
