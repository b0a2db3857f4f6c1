// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
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

enum Part : std::uint64_t { kEgoSpeed, kEgoSway, kParkedCars, kTrees, kHouses };

constexpr double kAisle = 17.0;  // m between two aisles

/// Up one aisle and down the next, again and again.
std::shared_ptr<const world::Route> make_route(double path_m) {
  std::vector<world::RoutePiece> pieces = {{7.0, 0.0, 0.0}};
  for (double length = 0.0; length < path_m; length += 120.0) {
    for (const double across : {3.0, 50.0, 3.0, 50.0}) {
      const std::vector<world::RoutePiece> bend = world::turn(0.5 * pi, 6.0, 3.0);
      pieces.insert(pieces.end(), bend.begin(), bend.end());
      pieces.push_back({across, 0.0, 0.0});
    }
  }
  return std::make_shared<const world::Route>(pieces);
}

/// Rows of cars side by side wherever the drive leaves room.
void add_rows(world::TriangleMesh& mesh, const world::Route& route, double path_m, const RandomSource& random) {
  for (int row = -3; row <= 4; ++row) {
    for (int place = -22; place <= 34; ++place) {
      const auto which = static_cast<std::uint64_t>((row + 10) * 1000 + place + 100);
      const Vector2d position(2.7 * place, 0.5 * kAisle + kAisle * 0.5 * row);
      if (!is_clear_of(route, -15.0, std::min(path_m, 130.0) + 130.0, position, 4.2)) {
        continue;
      }
      const world::Route spot({}, position, 0.0);
      add_parked_cars(mesh, spot, {0.0, 0.0, 0.0, 1.0, 0.15}, random.fork(kParkedCars).fork(which), 0.5 * pi);
    }
  }
}

}  // namespace

Scene build_car_park(const SceneRequest& request) {
  const double path_m = request.speed_mps * request.duration_s;
  const auto route = make_route(path_m);
  Scene scene;
  world::TriangleMesh& mesh = scene.world.statics;
  add_ground(mesh, {-150.0, -150.0}, {200.0, 150.0});
  add_rows(mesh, *route, path_m, request.random);
  const world::Route north({}, {-60.0, 62.0}, 0.0);
  const world::Route south({}, {-60.0, -52.0}, 0.0);
  const world::Route east({}, {95.0, -50.0}, 0.5 * pi);
  add_houses(mesh, north, {0.0, 160.0, 0.1, 22.0, 0.0}, request.random.fork(kHouses).fork(0));
  add_houses(mesh, south, {0.0, 160.0, -0.1, 19.0, 0.0}, request.random.fork(kHouses).fork(1));
  add_houses(mesh, east, {0.0, 110.0, -0.1, 25.0, 0.0}, request.random.fork(kHouses).fork(2));
  add_trees(mesh, north, {0.0, 160.0, -6.0, 14.0, 3.0}, request.random.fork(kTrees).fork(0));
  add_lamp_posts(mesh, south, {0.0, 160.0, 9.0, 25.0, 2.0}, request.random.fork(kTrees).fork(1));
  add_road_user_shapes(scene.world);
  const world::SpeedProfile speed =
      world::wandering_speed(request.speed_mps, 0.2, request.duration_s, request.random.fork(kEgoSpeed));
  scene.vehicle = world::drive(route, speed, {}, world::spring_sway(0.5, request.random.fork(kEgoSway)));
  return scene;
}

}  // namespace dynamic_icp::scenes
