// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <memory>
#include <numbers>
#include <vector>

#include "dynamic_icp/tools/scenes/builders.hpp"
#include "dynamic_icp/tools/scenes/parts.hpp"
#include "dynamic_icp/tools/scenes/traffic.hpp"
#include "dynamic_icp/tools/world/spring_sway.hpp"

namespace dynamic_icp::scenes {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

enum Part : std::uint64_t { kEgoSway, kHouses, kTrees, kLampPosts, kContainers, kLorries };

// Metres from the vehicle's lane, which goes along x, to the left.
constexpr double kOtherLane = 4.5;
constexpr double kYardEnd = 72.0;  // where the warehouses begin
constexpr double kRightFront = -11.0;
constexpr double kTurnRadius = 13.0;
constexpr double kRamp = 7.0;

/// Where and when a lorry turns.
struct Turn {
  double x_m = 0.0;  ///< the yard side of its way
  double begin_s = 0.0;
  double speed_mps = 0.0;
};

/// Comes towards the vehicle, turns into the yard and stops there.
world::Trajectory into_yard(const Turn& turn) {
  constexpr double kStraight = 400.0;
  std::vector<world::RoutePiece> pieces = {{kStraight, 0.0, 0.0}};
  const std::vector<world::RoutePiece> bend = world::turn(-0.5 * pi, kTurnRadius, kRamp);
  pieces.insert(pieces.end(), bend.begin(), bend.end());
  const auto route = std::make_shared<const world::Route>(pieces, Vector2d(turn.x_m + kStraight, kOtherLane), pi);
  const double start_m = kStraight - turn.speed_mps * turn.begin_s;
  const double end_s = turn.begin_s + 30.0 / turn.speed_mps;
  return world::drive(route, world::SpeedProfile({{end_s, turn.speed_mps}, {end_s + 4.0, 0.0}}), {start_m, 0.0, false});
}

/// Waits in the yard, leaves it and comes towards the vehicle.
world::Trajectory out_of_yard(const Turn& turn) {
  constexpr double kStraight = 20.0;
  std::vector<world::RoutePiece> pieces = {{kStraight, 0.0, 0.0}};
  const std::vector<world::RoutePiece> bend = world::turn(-0.5 * pi, kTurnRadius, kRamp);
  pieces.insert(pieces.end(), bend.begin(), bend.end());
  const world::Route way(pieces, Vector2d::Zero(), -0.5 * pi);
  const double depth_m = kOtherLane - way.at(way.length_m()).position.y();
  const auto route = std::make_shared<const world::Route>(pieces, Vector2d(turn.x_m, depth_m), -0.5 * pi);
  const world::SpeedProfile speed({{turn.begin_s - 5.0, 0.0}, {turn.begin_s - 2.0, turn.speed_mps}});
  return world::drive(route, speed, {kStraight - speed.distance_m(turn.begin_s), 0.0, false});
}

void add_lorries(world::World& world, const RoadUserShapes& shapes, const SceneRequest& request) {
  const double every_s = std::max(6.0, 7.0 / request.traffic);
  const int count = 2 + static_cast<int>(request.duration_s / every_s);
  for (int k = 0; k < count; ++k) {
    const RandomSource own = request.random.fork(kLorries).fork(static_cast<std::uint64_t>(k));
    const double begin_s = every_s * k + own.uniform(0, 0.0, 1.5);
    const Turn turn = {35.0 + std::max(request.speed_mps, 4.0) * begin_s + own.uniform(1, -3.0, 3.0), begin_s,
                       std::max(request.speed_mps, 4.0) + own.uniform(2, 0.2, 1.5)};
    const auto& add = own.uniform(3) < 0.5 ? add_tractor_with_semitrailer : add_truck_with_trailer;
    add(world, shapes, k % 2 == 0 ? into_yard(turn) : out_of_yard(turn), request.duration_s);
  }
}

void add_statics(world::TriangleMesh& mesh, double path_m, const RandomSource& random) {
  const double end_m = path_m + 180.0;
  add_ground(mesh, {-100.0, -60.0}, {end_m + 60.0, kYardEnd + 60.0});
  const world::Route road(std::vector<world::RoutePiece>{});
  add_houses(mesh, road, {-80.0, end_m, kYardEnd, 30.0, 0.0}, random.fork(kHouses).fork(0));
  add_houses(mesh, road, {-80.0, end_m, kRightFront, 14.0, 0.0}, random.fork(kHouses).fork(1));
  add_trees(mesh, road, {-70.0, end_m, -6.5, 19.0, 3.0}, random.fork(kTrees));
  add_lamp_posts(mesh, road, {-60.0, end_m, -4.5, 41.0, 1.0}, random.fork(kLampPosts));
  for (double x = -70.0; x < end_m; x += 27.0) {
    const RandomSource own = random.fork(kContainers).fork(static_cast<std::uint64_t>(x + 70.0));
    add_box(mesh, pose_on(road, x, 66.0 + own.uniform(0, -1.0, 1.0), 0.5 * pi), {6.1, 2.44, 2.59});
  }
}

}  // namespace

Scene build_freight(const SceneRequest& request) {
  Scene scene;
  add_statics(scene.world.statics, request.speed_mps * request.duration_s, request.random);
  const RoadUserShapes shapes = add_road_user_shapes(scene.world);
  if (request.traffic > 0.0) {
    add_lorries(scene.world, shapes, request);
  }
  const auto lane = std::make_shared<const world::Route>(std::vector<world::RoutePiece>{});
  scene.vehicle = world::drive(lane, world::SpeedProfile(request.speed_mps), {},
                               world::spring_sway(0.8, request.random.fork(kEgoSway)));
  return scene;
}

}  // namespace dynamic_icp::scenes
