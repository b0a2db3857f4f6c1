// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

#include "dynamic_icp/simulation/motion_state.hpp"
#include "dynamic_icp/simulation/random_source.hpp"
#include "dynamic_icp/simulation/world.hpp"

namespace dynamic_icp::simulation {

/// A world and the vehicle that drives through it.
struct Scene {
  World world;
  Trajectory vehicle;  ///< of the vehicle frame: on the road below the vehicle's middle, x forward, z up
};

/// What a scene is built for.
struct SceneRequest {
  double speed_mps = 0.0;   ///< mean speed of the vehicle
  double traffic = 1.0;     ///< density of moving road users: 0 none, 1 usual
  double duration_s = 0.0;  ///< the drive must have road for that long
  RandomSource random;      ///< decides on layout and traffic
};

/// A kind of scene that can be built.
struct SceneKind {
  std::string_view name;
  std::string_view description;
  double speed_mps = 0.0;  ///< default speed of the vehicle
  Scene (*build)(const SceneRequest& request) = nullptr;
};

/// All kinds of scenes, in the order in which they are listed.
std::span<const SceneKind> scene_kinds();

/// The kind of that name. Throws UsageError with the known names when there is none.
const SceneKind& find_scene(std::string_view name);

}  // namespace dynamic_icp::simulation
