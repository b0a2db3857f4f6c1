// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/scenes/scene_file_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/tools/scenes/scene_file_solids.hpp"
#include "dynamic_icp/tools/world/spring_sway.hpp"

namespace dynamic_icp::scenes {
namespace {

using formats::Limits;
using formats::YamlMap;

world::Trajectory read_free_motion(const YamlMap& map) {
  constexpr Limits kVelocity = {-100.0, 100.0};  // m/s
  constexpr Limits kSpin = {-3600.0, 3600.0};    // deg/s
  const Eigen::Isometry3d T_world_start =
      read_turned(map, Eigen::Isometry3d(Eigen::Translation3d(read_vector3(map, "position_m", kPosition))));
  const Eigen::Vector3d spin_dps = map.has("spin_dps") ? read_vector3(map, "spin_dps", kSpin) : Eigen::Vector3d::Zero();
  return free_motion(T_world_start, read_vector3(map, "velocity_mps", kVelocity), radians(1.0) * spin_dps);
}

/// Either `free` or the keys of a drive along a route.
world::Trajectory read_trajectory(const YamlMap& body, const Routes& routes) {
  if (body.has("free")) {
    if (body.has("route")) {
      body.fail("free", "stands beside 'route', expected one of them");
    }
    return read_free_motion(body.map("free"));
  }
  const NamedRoute& route = read_route(body, routes);
  return world::drive(route.route, read_speed(body), read_following(body, route, "start_m"));
}

/// The key `name`, which goes into result files.
std::string read_name(const YamlMap& body, const std::string& fallback) {
  const std::string name = fallback.empty() ? body.text("name") : body.text("name", fallback);
  const bool is_plain = std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
  if (!is_plain) {
    body.fail("name", fmt::format("is '{}', expected letters, digits, '-' and '_'", name));
  }
  return name;
}

/// The shape of a kind of road user; null for other kinds.
std::size_t RoadUserShapes::*road_user(const std::string& kind) {
  return kind == "car"          ? &RoadUserShapes::car
         : kind == "van"        ? &RoadUserShapes::van
         : kind == "truck"      ? &RoadUserShapes::truck
         : kind == "pedestrian" ? &RoadUserShapes::pedestrian
                                : nullptr;
}

BodyPart read_body(const std::string& kind, const YamlMap& body, const Routes& routes) {
  if (std::size_t RoadUserShapes::*shape = road_user(kind)) {
    return [shape, name = read_name(body, kind), trajectory = read_trajectory(body, routes)](
               world::World& world, const RoadUserShapes& shapes, double, const RandomSource&) {
      world::add_body(world, name, shapes.*shape, trajectory);
    };
  }
  if (kind != "object") {
    body.fail(fmt::format("'{}' is no body, expected one of: car, van, truck, pedestrian, object", kind));
  }
  return [name = read_name(body, ""), mesh = read_body_shape(body), trajectory = read_trajectory(body, routes)](
             world::World& world, const RoadUserShapes&, double, const RandomSource&) {
    world::add_body(world, name, world::add_shape(world, mesh), trajectory);
  };
}

/// The lane in denser or thinner traffic: about as long as it was, but never so dense that vehicles touch.
Lane scaled(Lane lane, double closest_m, double traffic) {
  const double spacing_m = std::max(closest_m, lane.spacing_m / traffic);
  lane.count = static_cast<int>(std::lround(lane.count * lane.spacing_m / spacing_m));
  lane.spacing_m = spacing_m;
  return lane;
}

BodyPart read_lane(const YamlMap& map, const Routes& routes) {
  const NamedRoute& route = read_route(map, routes);
  const world::RouteFollowing following = read_following(map, route, "first_m");
  Lane lane;
  lane.lateral_m = following.lateral_m;
  lane.against = following.against;
  lane.first_m = following.start_m;
  lane.truck_share = map.number("truck_share", {0.0, 1.0}, 0.0);
  // Places vary by a tenth of the spacing; vans are 5.6 m long, trucks 10 m.
  const double closest_m = lane.truck_share > 0.0 ? 14.0 : 8.0;
  lane.spacing_m = map.number("spacing_m", {closest_m, 1e4});
  lane.count = map.whole_number("count", {1, 1000});
  return [=, route = route.route, speed = read_speed(map)](world::World& world, const RoadUserShapes& shapes,
                                                           double traffic, const RandomSource& random) {
    add_lane(world, shapes, route, scaled(lane, closest_m, traffic), speed, random);
  };
}

}  // namespace

world::Trajectory free_motion(const Eigen::Isometry3d& T_world_start, const Eigen::Vector3d& velocity_world,
                              const Eigen::Vector3d& angular_velocity_world) {
  return [=](double time_s) {
    world::MotionState state;
    state.T_world_body.linear() = exp_so3(time_s * angular_velocity_world) * T_world_start.linear();
    state.T_world_body.translation() = T_world_start.translation() + time_s * velocity_world;
    state.velocity_world = velocity_world;
    state.angular_velocity_world = angular_velocity_world;
    return state;
  };
}

std::vector<BodyPart> read_bodies(const YamlMap& file, const Routes& routes) {
  std::vector<BodyPart> parts;
  for (const auto& [kind, body] : file.kinds("bodies")) {
    parts.push_back(read_body(kind, body, routes));
  }
  for (const YamlMap& lane : file.list("lanes")) {
    parts.push_back(read_lane(lane, routes));
  }
  return parts;
}

std::function<world::Trajectory(const SceneRequest& request)> read_vehicle(const YamlMap& file, const Routes& routes,
                                                                           double speed_mps) {
  const YamlMap map = file.map("vehicle");
  const NamedRoute& route = read_route(map, routes);
  const world::RouteFollowing following = read_following(map, route, "start_m");
  const double sway = map.number("sway", {0.0, 10.0}, 0.0);
  std::vector<world::SpeedKnot> shares = {{0.0, 1.0}};  // of the speed knob
  if (map.has("speed")) {
    if (speed_mps <= 0.0) {
      map.fail("speed", "needs a 'speed_mps' above 0 at the top of the file");
    }
    shares = read_speed_knots(map);
    for (world::SpeedKnot& knot : shares) {
      knot.speed_mps /= speed_mps;
    }
  }
  return [=, route = route.route](const SceneRequest& request) {
    std::vector<world::SpeedKnot> knots = shares;
    for (world::SpeedKnot& knot : knots) {
      knot.speed_mps *= request.speed_mps;
    }
    return world::drive(route, world::SpeedProfile(std::move(knots)), following,
                        sway > 0.0 ? world::spring_sway(sway, request.random) : world::SwayFunction());
  };
}

}  // namespace dynamic_icp::scenes
