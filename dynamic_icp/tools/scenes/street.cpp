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

namespace dynamic_icp::scenes {
namespace {

/// What each part of the scene draws its random numbers from.
enum Part : std::uint64_t {
  kEgoSpeed,
  kEgoSway,
  kHouses,
  kTrees,
  kLampPosts,
  kParkedCars,
  kLaneAhead,
  kLaneAheadSpeed,
  kOncoming,
  kOncomingSpeed
};

constexpr double kInnerLane = 1.65;  // m from the middle of the street
constexpr double kOuterLane = 4.95;
constexpr double kParking = 7.75;
constexpr double kKerb = 8.9;
constexpr double kTreeLine = 9.6;
constexpr double kHouseFront = 11.8;
constexpr double kKerbHeight = 0.12;
constexpr double kStreetBegin = -60.0;  // m along the route, the drive begins at 0
constexpr double kSightAfterDrive = 130.0;
constexpr double kAfterBend = 90.0;

/// Straight for the whole drive; then a bend whose houses close the view, and cars come round it.
std::shared_ptr<const world::Route> make_route(double path_m) {
  std::vector<world::RoutePiece> pieces = {{path_m + kSightAfterDrive, 0.0, 0.0}};
  const std::vector<world::RoutePiece> bend = world::turn(-0.5 * std::numbers::pi, 50.0, 20.0);
  pieces.insert(pieces.end(), bend.begin(), bend.end());
  pieces.push_back({kAfterBend, 0.0, 0.0});
  return std::make_shared<const world::Route>(pieces);
}

void add_street(world::TriangleMesh& mesh, const world::Route& route, const RandomSource& random) {
  const double begin = kStreetBegin;
  const double end = route.length_m();
  constexpr double kWidth = 32.0;
  const std::array<Eigen::Vector2d, 6> profile = {{{-kWidth, kKerbHeight},
                                                   {-kKerb, kKerbHeight},
                                                   {-kKerb, 0.0},
                                                   {kKerb, 0.0},
                                                   {kKerb, kKerbHeight},
                                                   {kWidth, kKerbHeight}}};
  add_ribbon(mesh, route, begin, end, 4.0, profile);
  for (const double side : {-1.0, 1.0}) {
    const std::uint64_t which = side < 0.0 ? 0 : 1;
    add_houses(mesh, route, {begin, end, side * kHouseFront, 13.0, 0.0}, random.fork(kHouses).fork(which));
    add_trees(mesh, route, {begin + 4.0, end, side * kTreeLine, 17.0, 3.0}, random.fork(kTrees).fork(which));
    add_lamp_posts(mesh, route, {begin + 12.5, end, side * kTreeLine, 34.0, 1.0}, random.fork(kLampPosts).fork(which));
    add_parked_cars(mesh, route, {begin, end, side * kParking, 7.5, 0.7}, random.fork(kParkedCars).fork(which));
  }
}

void add_traffic(world::World& world, const std::shared_ptr<const world::Route>& route, const SceneRequest& request) {
  const RoadUserShapes shapes = add_road_user_shapes(world);
  if (request.traffic <= 0.0) {
    return;
  }
  const RandomSource& random = request.random;
  // A little faster than the vehicle, on the lane to its right: the first stays in view, others catch up from behind.
  const double ahead_mps = std::max(request.speed_mps + 1.3, 8.0);
  const double spacing = 55.0 / request.traffic;
  const int behind = static_cast<int>((ahead_mps - request.speed_mps) * request.duration_s / spacing);
  const Lane ahead{-kOuterLane, false, 16.0 - behind * spacing, spacing, behind + 2};
  add_lane(world, shapes, route, ahead,
           world::wandering_speed(ahead_mps, 0.03, request.duration_s, random.fork(kLaneAheadSpeed)),
           random.fork(kLaneAhead));
  constexpr double kOncomingMean = 9.0;
  const double oncoming_spacing = 70.0 / request.traffic;
  const double first = 100.0;
  const double meeting_way = (request.speed_mps + kOncomingMean) * request.duration_s;
  const int more = static_cast<int>(std::ceil(meeting_way / oncoming_spacing));
  add_lane(world, shapes, route, {kInnerLane, true, first, oncoming_spacing, 1 + more},
           world::wandering_speed(kOncomingMean, 0.05, request.duration_s, random.fork(kOncomingSpeed)),
           random.fork(kOncoming));
}

}  // namespace

Scene build_street(const SceneRequest& request) {
  const auto route = make_route(request.speed_mps * request.duration_s);
  Scene scene;
  add_street(scene.world.statics, *route, request.random);
  add_traffic(scene.world, route, request);
  scene.vehicle = world::drive(
      route, world::wandering_speed(request.speed_mps, 0.06, request.duration_s, request.random.fork(kEgoSpeed)),
      {0.0, -kInnerLane, false},
      world::spring_sway(request.speed_mps > 0.0 ? 1.0 : 0.0, request.random.fork(kEgoSway)));
  return scene;
}

}  // namespace dynamic_icp::scenes
