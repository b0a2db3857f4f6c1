// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/tools/world/drive.hpp"
#include "dynamic_icp/tools/world/route.hpp"
#include "dynamic_icp/tools/world/speed_profile.hpp"
#include "dynamic_icp/tools/world/world.hpp"

namespace dynamic_icp::scenes {

/// Indices of the shapes of road users in a world.
struct RoadUserShapes {
  std::size_t car = 0;
  std::size_t van = 0;
  std::size_t truck = 0;
  std::size_t tractor = 0;
  std::size_t semitrailer = 0;
  std::size_t trailer = 0;
  std::size_t pedestrian = 0;
};

/// Adds the shapes of body_shapes.hpp to the world.
RoadUserShapes add_road_user_shapes(world::World& world);

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

/// Two bodies: one that drives like this, and one behind it until `end_s`.
void add_tractor_with_semitrailer(world::World& world, const RoadUserShapes& shapes, const world::Trajectory& tractor,
                                  double end_s);
void add_truck_with_trailer(world::World& world, const RoadUserShapes& shapes, const world::Trajectory& truck,
                            double end_s);

void add_lane(world::World& world, const RoadUserShapes& shapes, const std::shared_ptr<const world::Route>& route,
              const Lane& lane, const world::SpeedProfile& speed, const RandomSource& random);

}  // namespace dynamic_icp::scenes
