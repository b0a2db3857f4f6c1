// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/scenes/scene_file_routes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace dynamic_icp::scenes {
namespace {

using formats::Limits;
using formats::YamlMap;

constexpr Limits kSpeed = {0.0, 100.0};  // m/s

std::vector<world::RoutePiece> read_straight(const YamlMap& map) {
  return {{map.number("length_m", {0.01, 2e4}), 0.0, 0.0}};
}

std::vector<world::RoutePiece> read_turn(const YamlMap& map) {
  const double angle_deg = map.number("angle_deg", kAngle);
  const double radius_m = map.number("radius_m", {0.5, 1e4});
  const double ramp_m = map.number("ramp_m", {0.01, 1e4});
  const double turned_m = std::abs(radians(angle_deg)) * radius_m;
  if (turned_m > 2e4) {
    map.fail("angle_deg", fmt::format("makes a bend of {:g} m, expected at most 20000 m", turned_m));
  }
  if (ramp_m > turned_m) {
    map.fail("ramp_m", fmt::format("is {:g}, expected at most angle times radius, which is {:g}", ramp_m, turned_m));
  }
  return world::turn(radians(angle_deg), radius_m, ramp_m);
}

std::vector<world::RoutePiece> read_curve(const YamlMap& map) {
  constexpr Limits kCurvature = {-2.0, 2.0};  // 1/m
  return {{map.number("length_m", {0.01, 2e4}), map.number("curvature_begin", kCurvature),
           map.number("curvature_end", kCurvature)}};
}

std::vector<world::RoutePiece> read_pieces(const YamlMap& map) {
  std::vector<world::RoutePiece> pieces;
  for (const auto& [kind, piece] : map.kinds("pieces")) {
    std::vector<world::RoutePiece> more;
    if (kind == "straight") {
      more = read_straight(piece);
    } else if (kind == "turn") {
      more = read_turn(piece);
    } else if (kind == "curve") {
      more = read_curve(piece);
    } else {
      piece.fail(fmt::format("'{}' is no piece of a route, expected one of: straight, turn, curve", kind));
    }
    pieces.insert(pieces.end(), more.begin(), more.end());
  }
  return pieces;
}

}  // namespace

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

Eigen::Vector2d read_vector2(const YamlMap& map, std::string_view key, Limits limits) {
  const std::vector<double> numbers = map.numbers(key, 2, limits);
  return {numbers[0], numbers[1]};
}

Eigen::Vector3d read_vector3(const YamlMap& map, std::string_view key, Limits limits) {
  const std::vector<double> numbers = map.numbers(key, 3, limits);
  return {numbers[0], numbers[1], numbers[2]};
}

Routes read_routes(const YamlMap& file) {
  Routes routes;
  for (const auto& [name, map] : file.entries("routes")) {
    const Eigen::Vector2d start =
        map.has("start_m") ? read_vector2(map, "start_m", kPosition) : Eigen::Vector2d::Zero();
    const double heading_rad = radians(map.number("heading_deg", kAngle, 0.0));
    const std::vector<world::RoutePiece> pieces = read_pieces(map);
    NamedRoute named;
    named.route = std::make_shared<const world::Route>(pieces, start, heading_rad);
    for (const world::RoutePiece& piece : pieces) {
      named.min_curvature = std::min({named.min_curvature, piece.curvature_begin, piece.curvature_end});
      named.greatest_curvature = std::max({named.greatest_curvature, piece.curvature_begin, piece.curvature_end});
    }
    routes.emplace(name, std::move(named));
  }
  return routes;
}

const NamedRoute& read_route(const YamlMap& map, const Routes& routes) {
  std::vector<std::string> names;
  for (const auto& [name, route] : routes) {
    names.push_back(name);
  }
  return routes.at(map.choice("route", names));
}

double read_lateral(const YamlMap& map, std::string_view key, const NamedRoute& route, double fallback) {
  const double lateral_m = map.number(key, kPosition, fallback);
  const double bend = std::max(lateral_m * route.min_curvature, lateral_m * route.greatest_curvature);
  if (bend >= 1.0) {
    map.fail(key, fmt::format("is {:g}, expected less than the radius of the route's bends, which is {:g}", lateral_m,
                              std::abs(lateral_m) / bend));
  }
  return lateral_m;
}

world::RouteFollowing read_following(const YamlMap& map, const NamedRoute& route, std::string_view start_key) {
  return {map.number(start_key, kPosition, 0.0), read_lateral(map, "lateral_m", route, 0.0),
          map.flag("against", false)};
}

std::vector<world::SpeedKnot> read_speed_knots(const YamlMap& map) {
  std::vector<world::SpeedKnot> knots;
  for (const std::vector<double>& row : map.rows("speed", 2, {0.0, 1e5})) {
    if (row[1] > kSpeed.maximum) {
      map.fail("speed", fmt::format("has a speed of {:g}, expected 0 to {:g} m/s", row[1], kSpeed.maximum));
    }
    if (!knots.empty() && row[0] <= knots.back().time_s) {
      map.fail("speed", fmt::format("has the time {:g} after {:g}, expected [time_s, speed_mps] with increasing times",
                                    row[0], knots.back().time_s));
    }
    knots.push_back({row[0], row[1]});
  }
  return knots;
}

world::SpeedProfile read_speed(const YamlMap& map) {
  if (map.has("speed") && map.has("speed_mps")) {
    map.fail("speed", "stands beside 'speed_mps', expected one of them");
  }
  return map.has("speed") ? world::SpeedProfile(read_speed_knots(map))
                          : world::SpeedProfile(map.number("speed_mps", kSpeed));
}

Eigen::Isometry3d read_turned(const YamlMap& map, const Eigen::Isometry3d& T_world_place) {
  const auto about = [&](std::string_view key, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(radians(map.number(key, kAngle, 0.0)), axis);
  };
  return T_world_place * about("yaw_deg", Eigen::Vector3d::UnitZ()) * about("pitch_deg", Eigen::Vector3d::UnitY()) *
         about("roll_deg", Eigen::Vector3d::UnitX());
}

}  // namespace dynamic_icp::scenes
