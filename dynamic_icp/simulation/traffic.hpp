// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>

#include "dynamic_icp/simulation/drive.hpp"
#include "dynamic_icp/simulation/random_source.hpp"
#include "dynamic_icp/simulation/route.hpp"
#include "dynamic_icp/simulation/speed_profile.hpp"
#include "dynamic_icp/simulation/world.hpp"

namespace dynamic_icp::simulation {

/// Indices of the shapes of road users in a world.
struct RoadUserShapes {
  std::size_t car = 0;
  std::size_t van = 0;
  std::size_t truck = 0;
  std::size_t pedestrian = 0;
};

/// Adds the shapes of body_shapes.hpp to the world.
RoadUserShapes add_road_user_shapes(World& world);

/// Road users one behind the other on a lane of a route, all with the same speed at any time, so that they keep their
/// distances.
struct Lane {
  double lateral_m = 0.0;
  bool against = false;     ///< drive towards smaller arc lengths
  double first_m = 0.0;     ///< arc length of the first at time 0
  double spacing_m = 50.0;  ///< from each to the next, towards larger arc lengths; varies by a tenth
  int count = 0;
  double truck_share = 0.0;  ///< of the vehicles; a fifth of the others are vans
};

void add_lane(World& world, const RoadUserShapes& shapes, const std::shared_ptr<const Route>& route, const Lane& lane,
              const SpeedProfile& speed, const RandomSource& random);

/// The springs of a road vehicle: heave, pitch and roll as sums of slow sines (about 1 cm, 0.4 and 0.4 deg at scale 1).
SwayFunction spring_sway(double scale, const RandomSource& random);

/// Speed that wanders smoothly within `share` of its mean for the duration.
SpeedProfile wandering_speed(double mean_mps, double share, double duration_s, const RandomSource& random);

}  // namespace dynamic_icp::simulation
