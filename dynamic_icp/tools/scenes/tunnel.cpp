// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "dynamic_icp/tools/scenes/builders.hpp"
#include "dynamic_icp/tools/scenes/parts.hpp"
#include "dynamic_icp/tools/scenes/traffic.hpp"
#include "dynamic_icp/tools/world/spring_sway.hpp"

// The three scenes whose shape repeats or stays the same along the road: tunnel, curved walls and bridge.

namespace dynamic_icp::scenes {
namespace {

using Eigen::Vector2d;

enum Part : std::uint64_t { kEgoSpeed, kEgoSway, kAhead, kOncoming };

constexpr double kLane = 1.8;     // m from the middle of the road
constexpr double kBegin = -60.0;  // m along the route
constexpr double kSight = 300.0;

std::shared_ptr<const world::Route> straight_route(double path_m) {
  return std::make_shared<const world::Route>(std::vector<world::RoutePiece>{{path_m + kSight, 0.0, 0.0}});
}

/// One lane ahead of the vehicle with its speed, and one towards it.
void add_two_lanes(world::World& world, const std::shared_ptr<const world::Route>& route, const SceneRequest& request,
                   const world::SpeedProfile& ego_speed, double ahead_m) {
  const RoadUserShapes shapes = add_road_user_shapes(world);
  if (request.traffic <= 0.0) {
    return;
  }
  add_lane(world, shapes, route, {-kLane, false, ahead_m, 50.0 / request.traffic, 2}, ego_speed,
           request.random.fork(kAhead));
  const double oncoming_mps = std::max(request.speed_mps, 8.0);
  const double spacing = 80.0 / request.traffic;
  const int count = 3 + static_cast<int>((request.speed_mps + oncoming_mps) * request.duration_s / spacing);
  add_lane(world, shapes, route, {kLane, true, 60.0, spacing, count}, world::SpeedProfile(oncoming_mps),
           request.random.fork(kOncoming));
}

Scene drive_through(world::World world, const std::shared_ptr<const world::Route>& route, const SceneRequest& request,
                    double ahead_m) {
  const world::SpeedProfile speed =
      world::wandering_speed(request.speed_mps, 0.04, request.duration_s, request.random.fork(kEgoSpeed));
  Scene scene;
  scene.world = std::move(world);
  add_two_lanes(scene.world, route, request, speed, ahead_m);
  scene.vehicle =
      world::drive(route, speed, {0.0, -kLane, false}, world::spring_sway(0.7, request.random.fork(kEgoSway)));
  return scene;
}

}  // namespace

Scene build_tunnel(const SceneRequest& request) {
  const auto route = straight_route(request.speed_mps * request.duration_s);
  // Road, walls and a vault, once round from the right edge of the road; seen from inside.
  constexpr double kHalfWidth = 5.0;
  constexpr double kWall = 2.5;
  constexpr int kVault = 16;
  std::vector<Vector2d> section = {{-kHalfWidth, kWall}, {-kHalfWidth, 0.0}, {kHalfWidth, 0.0}};
  for (int i = 0; i <= kVault; ++i) {
    const double angle = std::numbers::pi * i / kVault;
    section.emplace_back(kHalfWidth * std::cos(angle), kWall + 0.8 * kHalfWidth * std::sin(angle));
  }
  world::World world;
  add_ribbon(world.statics, *route, kBegin, route->length_m(), 50.0, section, world::reflectivity::kConcrete);
  return drive_through(std::move(world), route, request, 28.0);
}

Scene build_curved_walls(const SceneRequest& request) {
  constexpr double kRadius = 90.0;
  const double path_m = request.speed_mps * request.duration_s;
  std::vector<world::RoutePiece> pieces = {{10.0, 0.0, 0.0}, {30.0, 0.0, 1.0 / kRadius}};
  // An S of long arcs: it never closes into a circle.
  for (double length = 0.0; length < path_m + kSight; length += 260.0) {
    pieces.push_back({100.0, 1.0 / kRadius, 1.0 / kRadius});
    pieces.push_back({30.0, 1.0 / kRadius, -1.0 / kRadius});
    pieces.push_back({100.0, -1.0 / kRadius, -1.0 / kRadius});
    pieces.push_back({30.0, -1.0 / kRadius, 1.0 / kRadius});
  }
  const auto route = std::make_shared<const world::Route>(pieces);
  const std::array<Vector2d, 4> section = {{{-6.5, 5.0}, {-6.5, 0.0}, {6.5, 0.0}, {6.5, 5.0}}};
  world::World world;
  add_ribbon(world.statics, *route, kBegin, route->length_m(), 1.0, section, world::reflectivity::kConcrete);
  return drive_through(std::move(world), route, request, 25.0);
}

Scene build_bridge(const SceneRequest& request) {
  const auto route = straight_route(request.speed_mps * request.duration_s);
  world::World world;
  const std::array<Vector2d, 6> deck = {{{-6.2, 0.0}, {-6.2, 0.0}, {-4.4, 0.0}, {4.4, 0.0}, {6.2, 0.0}, {6.2, -1.5}}};
  add_ribbon(world.statics, *route, kBegin, route->length_m(), 50.0, deck);
  const std::array<Vector2d, 2> water = {{{-200.0, -18.0}, {200.0, -18.0}}};
  add_ribbon(world.statics, *route, kBegin, route->length_m(), 50.0, water, world::reflectivity::kWater);
  // Every span is like every other: railing posts, beams and arches at equal distances.
  constexpr double kPostSpacing = 2.5;
  constexpr double kPortalSpacing = 20.0;
  for (const double side : {-1.0, 1.0}) {
    for (double s = kBegin; s < route->length_m(); s += kPostSpacing) {
      add_box(world.statics, pose_on(*route, s, side * 6.0), {0.12, 0.12, 1.15});
    }
    for (const double z : {0.4, 0.7, 1.05}) {
      const std::array<Vector2d, 4> beam = {
          {{side * 6.0 + 0.04, z}, {side * 6.0 - 0.04, z}, {side * 6.0 - 0.04, z + 0.1}, {side * 6.0 + 0.04, z + 0.1}}};
      add_ribbon(world.statics, *route, kBegin, route->length_m(), 50.0, beam, world::reflectivity::kZinc);
    }
    for (double s = kBegin; s < route->length_m(); s += kPortalSpacing) {
      add_box(world.statics, pose_on(*route, s, side * 5.2), {0.5, 0.4, 7.0});
    }
  }
  for (double s = kBegin; s < route->length_m(); s += kPortalSpacing) {
    add_box(world.statics, pose_on(*route, s, 0.0), {0.5, 10.8, 0.6}, 6.6);
  }
  return drive_through(std::move(world), route, request, 24.0);
}

}  // namespace dynamic_icp::scenes
