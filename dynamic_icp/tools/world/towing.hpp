// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/tools/world/motion_state.hpp"

namespace dynamic_icp::world {

/// How a trailer hangs on the vehicle that tows it. Both have their frames on the road below their middles, x forward.
struct Hitch {
  double on_vehicle_m = 0.0;  ///< x of the joint in the frame of the vehicle
  double on_trailer_m = 0.0;  ///< x of the joint in the frame of the trailer
  double axle_m = 0.0;        ///< x of the axle in the frame of the trailer, behind the joint
};

/// The motion of a trailer behind a vehicle on level ground, whose axle does not slip sideways: with the velocity v of
/// the joint, the trailer's heading psi and the distance L from the joint to the axle,
///   L psi' = v . (-sin psi, cos psi).
/// It is behind the vehicle in a straight line half a minute before time 0, and keeps its heading after `end_s`.
/// Throws std::invalid_argument if the axle is not behind the joint.
Trajectory tow(const Trajectory& vehicle, const Hitch& hitch, double end_s);

}  // namespace dynamic_icp::world
