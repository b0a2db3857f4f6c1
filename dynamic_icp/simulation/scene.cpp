// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/simulation/scene.hpp"

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>

#include "dynamic_icp/base/error.hpp"
#include "dynamic_icp/simulation/scene_builders.hpp"

namespace dynamic_icp::simulation {
namespace {

constexpr std::array kScenes = {
    SceneKind{"street", "straight street between house fronts; cars ahead in the next lane and oncoming", 13.0,
              build_street},
    SceneKind{"city", "right turn at a junction behind a turning car; crossing cars, pedestrians", 8.0, build_city},
    SceneKind{"highway", "long bends between guard rails, few planes; fast traffic both ways", 27.0, build_highway},
    SceneKind{"tunnel", "smooth straight tube: nothing to hold on to along the way", 20.0, build_tunnel},
    SceneKind{"curved-walls", "smooth walls in long bends, no features", 14.0, build_curved_walls},
    SceneKind{"bridge", "equal posts and portals at equal distances", 16.0, build_bridge},
    SceneKind{"jam", "seven lanes of stop and go: almost all that is seen moves", 3.0, build_jam},
    SceneKind{"roundabout", "round and round at 0.6 rad/s behind other cars", 7.8, build_roundabout},
    SceneKind{"car-park", "slow turns between parked cars, nothing moves", 3.5, build_car_park},
    SceneKind{"off-road", "winding over rough ground between trees: pitching and rolling", 6.0, build_off_road},
    SceneKind{"standing", "the vehicle stands in the street while traffic passes", 0.0, build_street},
};

}  // namespace

std::span<const SceneKind> scene_kinds() { return kScenes; }

const SceneKind& find_scene(std::string_view name) {
  const auto* const kind =
      std::find_if(kScenes.begin(), kScenes.end(), [&](const SceneKind& scene) { return scene.name == name; });
  if (kind == kScenes.end()) {
    std::string names;
    for (const SceneKind& scene : kScenes) {
      names += fmt::format("{}{}", names.empty() ? "" : ", ", scene.name);
    }
    throw UsageError(fmt::format("unknown scene '{}', expected one of: {}", name, names));
  }
  return *kind;
}

}  // namespace dynamic_icp::simulation
