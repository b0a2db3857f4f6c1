// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/tools/world/motion_state.hpp"
#include "dynamic_icp/tools/world/world.hpp"

namespace dynamic_icp::scenes {

/// A world and the vehicle that drives through it.
struct Scene {
  world::World world;
  world::Trajectory vehicle;  ///< of the vehicle frame: on the road below the vehicle's middle, x forward, z up
};

/// What is built.
struct SceneRequest {
  double speed_mps = 0.0;   ///< mean speed of the vehicle
  double traffic = 1.0;     ///< density of moving road users: 0 none, 1 usual
  double duration_s = 0.0;  ///< the drive must have road for that long
  RandomSource random;      ///< decides on layout and traffic
};

/// A kind of scene that can be built.
struct SceneKind {
  std::string name;
  std::string description;
  double speed_mps = 0.0;  ///< default speed of the vehicle
  std::function<Scene(const SceneRequest& request)> build;
  std::string former_name = {};  ///< up to version 0.1; understood for one release more
};

/// All kinds of scenes that come with the program, in the order in which they are listed.
const std::vector<SceneKind>& scene_kinds();

/// The kind of that name. Throws UsageError with the known names when there is none.
const SceneKind& find_scene(std::string_view name);

/// What users decide about a scene.
struct SceneKnobs {
  int seed = 1;
  double speed_mps = 13.0;
  double traffic = 1.0;
};

ConfigFields fields(SceneKnobs& knobs);

/// The defaults for this kind of scene.
SceneKnobs default_knobs(const SceneKind& kind);

/// The scene for a drive of this length. Throws UsageError when a knob is out of range.
Scene build_scene(const SceneKind& kind, SceneKnobs knobs, double duration_s);

}  // namespace dynamic_icp::scenes
