// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "dynamic_icp/tools/scenes/builders.hpp"
#include "dynamic_icp/tools/scenes/parts.hpp"
#include "dynamic_icp/tools/scenes/traffic.hpp"
#include "dynamic_icp/tools/world/spring_sway.hpp"

namespace dynamic_icp::scenes {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

enum Part : std::uint64_t { kEgoSway, kHouses, kTrees, kIsland, kParkedCars, kWalkers };

constexpr double kRadius = 13.0;  // of the lane round the island
constexpr double kApproach = 10.0;
constexpr double kHouseFront = 17.0;  // outside of the lane

/// Straight on, a little to the right, then round and round to the left.
struct Way {
  std::shared_ptr<const world::Route> route;
  Vector2d center;
};

Way make_way(double path_m) {
  std::vector<world::RoutePiece> pieces = {{kApproach, 0.0, 0.0}};
  const std::vector<world::RoutePiece> aside = world::turn(-0.7, 12.0, 5.0);
  pieces.insert(pieces.end(), aside.begin(), aside.end());
  pieces.push_back({5.0, 0.0, 1.0 / kRadius});
  pieces.push_back({path_m + 120.0, 1.0 / kRadius, 1.0 / kRadius});
  Way way;
  way.route = std::make_shared<const world::Route>(pieces);
  const world::RoutePoint on_ring = way.route->at(way.route->length_m() - 1.0);
  way.center = on_ring.position + kRadius * Vector2d(-std::sin(on_ring.heading_rad), std::cos(on_ring.heading_rad));
  return way;
}

void add_island(world::TriangleMesh& mesh, const Vector2d& center, const RandomSource& random) {
  const Eigen::Isometry3d T(Eigen::Translation3d(center.x(), center.y(), 0.0));
  append(mesh, world::make_cylinder(8.0, 0.25, 48), T);
  append(mesh, world::make_ellipsoid({7.0, 7.0, 1.1}, 10, 32), T);
  add_box(mesh, T, {1.6, 1.6, 1.2}, 0.9);
  append(mesh, world::make_cylinder(0.4, 5.0, 16), T);
  for (std::uint64_t i = 0; i < 5; ++i) {
    const double angle = 2.0 * pi * (static_cast<double>(i) + random.fork(i).uniform(0, -0.2, 0.2)) / 5.0;
    add_tree(mesh, T * Eigen::Translation3d(5.0 * std::cos(angle), 5.0 * std::sin(angle), 0.2), random.fork(i));
  }
}

/// Houses, trees and parked cars round the place, with a gap where each of four streets comes in.
void add_surroundings(world::TriangleMesh& mesh, const Way& way, const RandomSource& random) {
  const Vector2d to_start = -way.center;
  const double street = std::atan2(to_start.y(), to_start.x());
  // A circle through the lane, begun in the middle of the vehicle's street.
  const world::Route circle({{2.0 * pi * kRadius, 1.0 / kRadius, 1.0 / kRadius}},
                            way.center + kRadius * Vector2d(std::cos(street), std::sin(street)), street + 0.5 * pi);
  const double quarter = 0.5 * pi * kRadius;
  for (std::uint64_t i = 0; i < 4; ++i) {
    const double begin = (static_cast<double>(i) + 0.24) * quarter;
    const double end = (static_cast<double>(i) + 0.76) * quarter;
    // Spacing is measured on the lane; at the fronts it is larger by the ratio of the radii.
    const double widening = (kRadius + kHouseFront) / kRadius;
    add_houses(mesh, circle, {begin, end, -kHouseFront, 10.0 / widening, 0.0}, random.fork(kHouses).fork(i));
    add_trees(mesh, circle, {begin, end, -kHouseFront + 4.5, 4.5, 0.5}, random.fork(kTrees).fork(i));
    add_parked_cars(mesh, circle, {begin, end, -kHouseFront + 8.5, 4.2, 0.1}, random.fork(kParkedCars).fork(i));
  }
  // Rows of houses along the four streets, beyond the place.
  for (std::uint64_t i = 0; i < 4; ++i) {
    const double angle = street + 0.5 * pi * static_cast<double>(i);
    const Vector2d outwards(std::cos(angle), std::sin(angle));
    const world::Route road({}, way.center, angle);
    for (const double side : {-1.0, 1.0}) {
      add_houses(mesh, road, {44.0, 130.0, side * 11.0, 12.0, 0.0},
                 random.fork(kHouses).fork(8 + 2 * i + (side < 0.0 ? 0 : 1)));
    }
    add_trees(mesh, road, {40.0, 130.0, 8.0, 15.0, 2.0}, random.fork(kTrees).fork(8 + i));
  }
}

}  // namespace

Scene build_roundabout(const SceneRequest& request) {
  const Way way = make_way(request.speed_mps * request.duration_s);
  Scene scene;
  world::TriangleMesh& mesh = scene.world.statics;
  add_ground(mesh, way.center - Vector2d(160.0, 160.0), way.center + Vector2d(160.0, 160.0));
  add_island(mesh, way.center, request.random.fork(kIsland));
  add_surroundings(mesh, way, request.random);
  const RoadUserShapes shapes = add_road_user_shapes(scene.world);
  const world::SpeedProfile speed(request.speed_mps);
  if (request.traffic > 0.0) {
    // All go round at the same speed. The circle is 82 m long: room for the vehicle and three others.
    const int others = std::min(3, static_cast<int>(std::ceil(2.0 * request.traffic)));
    for (int i = 0; i < others; ++i) {
      const bool van = i == 1;
      world::add_body(scene.world, van ? "van" : "car", van ? shapes.van : shapes.car,
                      world::drive(way.route, speed, {34.0 + 19.0 * i, 0.0, false}));
    }
    const world::Route circle_walk({{400.0, 1.0 / 21.0, 1.0 / 21.0}}, way.center + Vector2d(21.0, 0.0), 0.5 * pi);
    const auto walk = std::make_shared<const world::Route>(circle_walk);
    for (int i = 0; i < static_cast<int>(4 * request.traffic); ++i) {
      const RandomSource own = request.random.fork(kWalkers).fork(static_cast<std::uint64_t>(i));
      world::add_body(scene.world, "pedestrian", shapes.pedestrian,
                      world::drive(walk, world::SpeedProfile(1.3), {own.uniform(0, 0.0, 3.0) + 8.0 * i, -6.5, false}));
    }
  }
  scene.vehicle = world::drive(way.route, speed, {}, world::spring_sway(0.8, request.random.fork(kEgoSway)));
  return scene;
}

}  // namespace dynamic_icp::scenes
