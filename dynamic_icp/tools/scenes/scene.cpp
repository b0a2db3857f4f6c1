// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/scenes/scene.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/nearest_key.hpp"
#include "dynamic_icp/tools/scenes/builders.hpp"

namespace dynamic_icp::scenes {

const std::vector<SceneKind>& scene_kinds() {
  static const std::vector<SceneKind> kinds = {
      {"street", "straight street between house fronts; cars ahead in the next lane and oncoming", 13.0, build_street},
      {"city", "right turn at a junction behind a turning car; crossing cars, pedestrians", 8.0, build_city},
      {"highway", "long bends between guard rails, few planes; fast traffic both ways", 27.0, build_highway},
      {"tunnel", "smooth straight tube: translation along it is unobservable by geometry", 20.0, build_tunnel},
      {"curved-walls", "smooth walls in long bends, no features", 14.0, build_curved_walls},
      {"bridge", "equal posts and portals at equal distances", 16.0, build_bridge},
      {"traffic-jam", "seven lanes of stop and go: almost all that is seen moves", 3.0, build_jam, "jam"},
      {"roundabout", "round and round at 0.6 rad/s behind other cars", 7.8, build_roundabout},
      {"freight", "articulated lorries turn into a yard and out of it", 5.0, build_freight},
      {"parking", "slow turns between parked cars, no dynamic objects", 3.5, build_car_park, "car-park"},
      {"off-road", "winding over rough ground between trees: pitching and rolling", 6.0, build_off_road},
      {"stationary", "stationary vehicle in the street while traffic passes", 0.0, build_street, "standing"},
  };
  return kinds;
}

const SceneKind& find_scene(std::string_view name) {
  const std::vector<SceneKind>& kinds = scene_kinds();
  const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const SceneKind& scene) {
    return scene.name == name || (!name.empty() && scene.former_name == name);
  });
  if (kind == kinds.end()) {
    std::vector<std::string> names;
    for (const SceneKind& scene : kinds) {
      names.emplace_back(scene.name);
    }
    throw UsageError(fmt::format("unknown scene '{}'{}; expected a scene file (*.yaml) or one of: {}", name,
                                 did_you_mean(name, names), fmt::join(names, ", ")));
  }
  return *kind;
}

ConfigFields fields(SceneKnobs& knobs) {
  return {
      {"seed", &knobs.seed, 0, 1e9, "", "decides on layout, traffic and noise"},
      {"speed", &knobs.speed_mps, 0.0, 70.0, "m/s", "mean speed of the vehicle"},
      {"traffic", &knobs.traffic, 0.0, 3.0, "", "density of moving road users: 0 none, 1 usual"},
  };
}

SceneKnobs default_knobs(const SceneKind& kind) {
  SceneKnobs knobs;
  knobs.speed_mps = kind.speed_mps;
  return knobs;
}

Scene build_scene(const SceneKind& kind, SceneKnobs knobs, double duration_s) {
  check_fields(fields(knobs));
  constexpr std::uint64_t kLayout = 0;  // the simulation's noise is another fork of the same seed
  const RandomSource random = RandomSource(static_cast<std::uint64_t>(knobs.seed)).fork(kLayout);
  return kind.build({knobs.speed_mps, knobs.traffic, duration_s, random});
}

}  // namespace dynamic_icp::scenes
