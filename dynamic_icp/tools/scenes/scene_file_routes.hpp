// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/recording/formats/yaml_map.hpp"
#include "dynamic_icp/tools/world/drive.hpp"
#include "dynamic_icp/tools/world/route.hpp"
#include "dynamic_icp/tools/world/speed_profile.hpp"

// What the readers of scene files share: routes, places along them, speeds.
namespace dynamic_icp::scenes {

constexpr double kFarthest = 1e5;                               ///< m
constexpr formats::Limits kPosition = {-kFarthest, kFarthest};  ///< m
constexpr formats::Limits kLength = {0.001, 1e4};               ///< m
constexpr formats::Limits kAngle = {-3600.0, 3600.0};           ///< deg

double radians(double degrees);

/// A route of a scene file, with the range of its curvature (1/m).
struct NamedRoute {
  std::shared_ptr<const world::Route> route;
  double min_curvature = 0.0;
  double greatest_curvature = 0.0;
};

using Routes = std::map<std::string, NamedRoute>;

/// The map `routes` of a scene file.
Routes read_routes(const formats::YamlMap& file);

/// The route that `map` names with its key `route`.
const NamedRoute& read_route(const formats::YamlMap& map, const Routes& routes);

/// The number at `key`, a distance to the left of the route: nearer than the centres of its bends.
double read_lateral(const formats::YamlMap& map, std::string_view key, const NamedRoute& route, double fallback);

/// The keys `start_m` (or another name), `lateral_m` and `against`.
world::RouteFollowing read_following(const formats::YamlMap& map, const NamedRoute& route, std::string_view start_key);

/// The key `speed`: a list of [time_s, speed_mps] with increasing times.
std::vector<world::SpeedKnot> read_speed_knots(const formats::YamlMap& map);

/// Either `speed_mps` or `speed`.
world::SpeedProfile read_speed(const formats::YamlMap& map);

/// The place turned in its own frame by Rz(yaw_deg) Ry(pitch_deg) Rx(roll_deg); the angles are 0 where keys are
/// missing.
Eigen::Isometry3d read_turned(const formats::YamlMap& map, const Eigen::Isometry3d& T_world_place);

Eigen::Vector2d read_vector2(const formats::YamlMap& map, std::string_view key, formats::Limits limits);
Eigen::Vector3d read_vector3(const formats::YamlMap& map, std::string_view key, formats::Limits limits);

}  // namespace dynamic_icp::scenes
