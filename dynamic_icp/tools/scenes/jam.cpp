// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "dynamic_icp/tools/scenes/builders.hpp"
#include "dynamic_icp/tools/scenes/parts.hpp"
#include "dynamic_icp/tools/scenes/traffic.hpp"

namespace dynamic_icp::scenes {
namespace {

using Eigen::Vector2d;

enum Part : std::uint64_t { kTrees, kLanes, kWaves };

constexpr double kLaneWidth = 3.3;
constexpr double kBegin = -60.0;
constexpr double kSight = 260.0;

std::shared_ptr<const world::Route> make_route(double path_m) {
  constexpr double kCurvature = 1.0 / 350.0;
  return std::make_shared<const world::Route>(std::vector<world::RoutePiece>{
      {10.0, 0.0, 0.0}, {60.0, 0.0, kCurvature}, {path_m + kSight, kCurvature, kCurvature}});
}

void add_statics(world::TriangleMesh& mesh, const world::Route& route, const RandomSource& random) {
  const double end = route.length_m();
  const std::array<Vector2d, 6> section = {
      {{-40.0, 1.5}, {-12.0, 0.0}, {12.0, 0.0}, {12.3, 0.0}, {12.3, 0.9}, {12.5, 0.9}}};
  add_ribbon(mesh, route, kBegin, end, 5.0, section);
  add_trees(mesh, route, {kBegin, end, -16.0, 18.0, 6.0}, random.fork(kTrees).fork(0));
  add_lamp_posts(mesh, route, {kBegin, end, 12.9, 30.0, 0.0}, random.fork(kTrees).fork(1));
}

/// Waves of going and almost standing, one every 7 s.
world::SpeedProfile stop_and_go(double mean_mps, double duration_s, const RandomSource& random) {
  constexpr double kHalfWave = 3.5;  // s
  std::vector<world::SpeedKnot> knots;
  const double phase = random.uniform(100, 0.0, 2.0 * kHalfWave);
  const double first_share = 0.25;
  for (int i = 0; i * kHalfWave <= duration_s + 3.0 * kHalfWave; ++i) {
    const double share = i % 2 == 0 ? 2.0 - first_share : first_share;
    const double wander = random.uniform(static_cast<std::uint64_t>(i), 0.85, 1.15);
    knots.push_back({i * kHalfWave - phase, mean_mps * share * wander});
  }
  return world::SpeedProfile(std::move(knots));
}

}  // namespace

Scene build_jam(const SceneRequest& request) {
  const double path_m = request.speed_mps * request.duration_s;
  const auto route = make_route(path_m);
  Scene scene;
  add_statics(scene.world.statics, *route, request.random);
  const RoadUserShapes shapes = add_road_user_shapes(scene.world);
  const world::SpeedProfile ego_speed = stop_and_go(request.speed_mps, request.duration_s, request.random.fork(kWaves));
  if (request.traffic > 0.0) {
    // Seven lanes the same way; the vehicle is on the middle one. Closer than bumper to bumper is impossible.
    const double spacing = std::max(13.0, 13.5 / request.traffic);
    for (int lane = -3; lane <= 3; ++lane) {
      const auto which = static_cast<std::uint64_t>(lane + 3);
      const world::SpeedProfile speed = lane == 0
                                            ? ego_speed
                                            : stop_and_go(request.speed_mps * (1.0 + 0.12 * lane), request.duration_s,
                                                          request.random.fork(kWaves).fork(which));
      const double first = lane == 0 ? 11.5 : -20.0;
      const int count = static_cast<int>((140.0 - first) / spacing);
      add_lane(scene.world, shapes, route, {lane * kLaneWidth, false, first, spacing, count, lane == 0 ? 0.0 : 0.25},
               speed, request.random.fork(kLanes).fork(which));
    }
  }
  scene.vehicle = world::drive(route, ego_speed, {});
  return scene;
}

}  // namespace dynamic_icp::scenes
