// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "dynamic_icp/tools/scenes/builders.hpp"
#include "dynamic_icp/tools/scenes/parts.hpp"
#include "dynamic_icp/tools/scenes/traffic.hpp"
#include "dynamic_icp/tools/world/spring_sway.hpp"

namespace dynamic_icp::scenes {
namespace {

using Eigen::Vector2d;

enum Part : std::uint64_t { kEgoSpeed, kEgoSway, kTrees, kFastLane, kSlowLane, kOwnLane, kOncomingFast, kOncomingSlow };

// Lanes left and right of the median, m from it.
constexpr double kFast = 3.1;
constexpr double kMiddle = 6.8;
constexpr double kSlow = 10.5;
constexpr double kRail = 14.0;
constexpr double kBegin = -120.0;

/// Long bends to the left and to the right in turn.
std::shared_ptr<const world::Route> make_route(double path_m) {
  constexpr double kCurvature = 1.0 / 900.0;
  constexpr double kRamp = 120.0;
  constexpr double kArc = 250.0;
  std::vector<world::RoutePiece> pieces = {{60.0, 0.0, 0.0}};
  double side = 1.0;
  for (double length = 0.0; length < path_m + 500.0; length += 2.0 * kRamp + kArc) {
    pieces.push_back({kRamp, 0.0, side * kCurvature});
    pieces.push_back({kArc, side * kCurvature, side * kCurvature});
    pieces.push_back({kRamp, side * kCurvature, 0.0});
    side = -side;
  }
  return std::make_shared<const world::Route>(pieces);
}

void add_rail(world::TriangleMesh& mesh, const world::Route& route, double begin_m, double end_m, double lateral_m) {
  const std::array<Vector2d, 4> beam = {
      {{lateral_m + 0.05, 0.45}, {lateral_m - 0.03, 0.53}, {lateral_m - 0.03, 0.67}, {lateral_m + 0.05, 0.75}}};
  add_ribbon(mesh, route, begin_m, end_m, 10.0, beam, world::reflectivity::kZinc);
  for (double s = begin_m; s < end_m; s += 4.0) {
    add_box(mesh, pose_on(route, s, lateral_m + std::copysign(0.15, lateral_m)), {0.1, 0.1, 0.8}, 0.0,
            world::reflectivity::kZinc);
  }
}

/// A portal of signs across one carriageway.
void add_gantry(world::TriangleMesh& mesh, const world::Route& route, double s_m, double side) {
  for (const double lateral : {1.0, kRail + 0.8}) {
    add_box(mesh, pose_on(route, s_m, side * lateral), {0.35, 0.35, 6.5});
  }
  add_box(mesh, pose_on(route, s_m, side * 0.5 * (kRail + 1.8)), {0.5, kRail + 0.2, 0.5}, 6.0);
  for (const double lateral : {kFast, kMiddle, kSlow}) {
    add_box(mesh, pose_on(route, s_m, side * lateral), {0.2, 2.6, 2.2}, 5.2, world::reflectivity::kSign);
  }
}

void add_statics(world::TriangleMesh& mesh, const world::Route& route, const RandomSource& random) {
  const double end = route.length_m();
  // Embankments rise beyond the rails; the concrete median is part of the section.
  const std::array<Vector2d, 12> section = {{{-60.0, 5.5},
                                             {-36.0, 3.5},
                                             {-17.0, -0.4},
                                             {-13.2, 0.0},
                                             {-0.35, 0.0},
                                             {-0.12, 0.3},
                                             {-0.08, 0.9},
                                             {0.08, 0.9},
                                             {0.12, 0.3},
                                             {0.35, 0.0},
                                             {13.2, 0.0},
                                             {60.0, 2.5}}};
  add_ribbon(mesh, route, kBegin, end, 10.0, section, 0.25);
  for (const double side : {-1.0, 1.0}) {
    add_rail(mesh, route, kBegin, end, side * kRail);
    for (double s = side < 0.0 ? 110.0 : 170.0; s < end; s += 240.0) {
      add_gantry(mesh, route, s, side);
    }
    const std::uint64_t which = side < 0.0 ? 0 : 1;
    add_trees(mesh, route, {kBegin, end, side * 19.0, 26.0, 9.0}, random.fork(kTrees).fork(which));
    add_trees(mesh, route, {kBegin + 9.0, end, side * 25.0, 31.0, 12.0}, random.fork(kTrees).fork(2 + which));
  }
}

void add_traffic(world::World& world, const std::shared_ptr<const world::Route>& route, const SceneRequest& request,
                 const world::SpeedProfile& ego_speed) {
  const RoadUserShapes shapes = add_road_user_shapes(world);
  if (request.traffic <= 0.0) {
    return;
  }
  const auto add = [&](Part part, double lateral, bool against, double relative_mps, double first_m, double spacing_m,
                       double trucks) {
    const double spacing = spacing_m / request.traffic;
    const int met = 3 + static_cast<int>(std::abs(relative_mps) * request.duration_s / spacing);
    // Faster ones come from behind, all others from ahead.
    const double first = relative_mps > 0.0 && !against ? first_m - (met - 3) * spacing : first_m;
    const double speed = against ? relative_mps - request.speed_mps : request.speed_mps + relative_mps;
    add_lane(world, shapes, route, {lateral, against, first, spacing, met, trucks},
             world::SpeedProfile(std::max(speed, 5.0)), request.random.fork(part));
  };
  add(kFastLane, -kFast, false, 4.5, -14.0, 60.0, 0.0);
  add(kSlowLane, -kSlow, false, -4.0, 16.0, 55.0, 0.6);
  add(kOncomingFast, kFast, true, request.speed_mps + 32.0, 30.0, 90.0, 0.0);
  add(kOncomingSlow, kSlow, true, request.speed_mps + 24.0, 50.0, 80.0, 0.5);
  add_lane(world, shapes, route, {-kMiddle, false, 38.0, 60.0 / request.traffic, 2}, ego_speed,
           request.random.fork(kOwnLane));
}

}  // namespace

Scene build_highway(const SceneRequest& request) {
  const auto route = make_route(request.speed_mps * request.duration_s);
  const world::SpeedProfile speed =
      world::wandering_speed(request.speed_mps, 0.02, request.duration_s, request.random.fork(kEgoSpeed));
  Scene scene;
  add_statics(scene.world.statics, *route, request.random);
  add_traffic(scene.world, route, request, speed);
  scene.vehicle =
      world::drive(route, speed, {0.0, -kMiddle, false}, world::spring_sway(0.8, request.random.fork(kEgoSway)));
  return scene;
}

}  // namespace dynamic_icp::scenes
