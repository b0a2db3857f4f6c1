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

enum Part : std::uint64_t {
  kEgoSway,
  kHouses,
  kTrees,
  kLampPosts,
  kParkedCars,
  kOncoming,
  kCrossing,
  kAhead,
  kWalkers
};

// Both streets have one lane each way and parking at the kerbs; numbers are metres from the vehicle's lane, to the
// left.
constexpr double kOtherLane = 3.5;
constexpr double kRightParking = -3.45;
constexpr double kLeftParking = 6.95;
constexpr double kRightKerb = -4.7;
constexpr double kLeftKerb = 8.2;
constexpr double kRightFront = -8.2;
constexpr double kLeftFront = 11.7;
constexpr double kApproach = 20.0;  // straight before the turn
constexpr double kHalfBlock = 170.0;

/// The junction of the street on which the vehicle comes (along x) with the one it turns right into (towards -y).
struct Junction {
  std::shared_ptr<const world::Route> drive;   ///< the vehicle's way
  std::shared_ptr<const world::Route> first;   ///< its lane of the first street, straight on
  std::shared_ptr<const world::Route> second;  ///< its lane of the second street, from north to south
  double turn_end_m = 0.0;                     ///< arc length of `drive` where the turn is over
  double x = 0.0;                              ///< of the vehicle's lane in the second street
  double y = 0.0;                              ///< where the turn is over
};

Junction make_junction(double path_m) {
  std::vector<world::RoutePiece> pieces = {{kApproach, 0.0, 0.0}};
  const std::vector<world::RoutePiece> bend = world::turn(-0.5 * std::numbers::pi, 10.0, 6.0);
  pieces.insert(pieces.end(), bend.begin(), bend.end());
  Junction junction;
  junction.drive = std::make_shared<const world::Route>(pieces);
  junction.turn_end_m = junction.drive->length_m();
  const Vector2d end = junction.drive->at(junction.turn_end_m).position;
  junction.x = end.x();
  junction.y = end.y();
  junction.first = std::make_shared<const world::Route>(std::vector<world::RoutePiece>{});
  const Vector2d north(junction.x, kHalfBlock);
  junction.second = std::make_shared<const world::Route>(
      std::vector<world::RoutePiece>{{2.0 * kHalfBlock + path_m, 0.0, 0.0}}, north, -0.5 * std::numbers::pi);
  return junction;
}

void add_blocks(world::TriangleMesh& mesh, const Junction& junction, double path_m) {
  const double far_south = -kHalfBlock - path_m;
  const double west = junction.x + kRightKerb;
  const double east = junction.x + kLeftKerb;
  const double far_east = junction.x + kHalfBlock;
  add_ground(mesh, {-80.0, far_south}, {far_east, kHalfBlock});
  add_pavement(mesh, {-80.0, far_south}, {west, kRightKerb});
  add_pavement(mesh, {-80.0, kLeftKerb}, {west, kHalfBlock});
  add_pavement(mesh, {east, far_south}, {far_east, kRightKerb});
  add_pavement(mesh, {east, kLeftKerb}, {far_east, kHalfBlock});
}

/// What lines a stretch of street on both sides.
void add_street_sides(world::TriangleMesh& mesh, const world::Route& lane, double begin_m, double end_m,
                      double parking_end_m, const RandomSource& random) {
  add_houses(mesh, lane, {begin_m, end_m, kRightFront, 12.0}, random.fork(kHouses).fork(0));
  add_houses(mesh, lane, {begin_m, end_m, kLeftFront, 12.0}, random.fork(kHouses).fork(1));
  add_trees(mesh, lane, {begin_m + 5.0, end_m - 3.0, kLeftKerb + 0.8, 16.0, 2.0}, random.fork(kTrees));
  add_lamp_posts(mesh, lane, {begin_m + 9.0, end_m - 1.0, kRightKerb - 0.6, 23.0, 1.0}, random.fork(kLampPosts));
  constexpr double kFreeCorner = 7.0;
  const double parking_begin_m = begin_m + kFreeCorner;
  add_parked_cars(mesh, lane, {parking_begin_m, parking_end_m, kRightParking, 7.5, 0.6},
                  random.fork(kParkedCars).fork(0));
  add_parked_cars(mesh, lane, {parking_begin_m, parking_end_m, kLeftParking, 7.5, 0.6},
                  random.fork(kParkedCars).fork(1));
}

void add_statics(world::TriangleMesh& mesh, const Junction& junction, double path_m, const RandomSource& random) {
  add_blocks(mesh, junction, path_m);
  const double after_first = junction.x + kLeftFront;
  add_street_sides(mesh, *junction.first, -70.0, junction.x + kRightFront, 6.0, random.fork(0));
  add_street_sides(mesh, *junction.first, after_first, junction.x + 160.0, junction.x + 160.0, random.fork(1));
  // Corner houses belong to the first street; those of the second begin behind them.
  constexpr double kCornerDepth = 12.0;
  const double north_end = kHalfBlock - kLeftFront - kCornerDepth;
  const double south_begin = kHalfBlock - kRightFront + kCornerDepth;
  add_street_sides(mesh, *junction.second, 0.0, north_end, north_end, random.fork(2));
  add_street_sides(mesh, *junction.second, south_begin, 2.0 * kHalfBlock + path_m, 2.0 * kHalfBlock + path_m,
                   random.fork(3));
}

/// Slower through the turn.
world::SpeedProfile turning_speed(double mean_mps, double turn_length_m) {
  if (mean_mps <= 0.0) {
    return world::SpeedProfile(0.0);
  }
  const double fast = 1.15 * mean_mps;
  const double slow = 0.7 * mean_mps;
  constexpr double kChange = 1.5;  // s
  const double begin = (kApproach - 0.5 * kChange * (fast + slow)) / fast;
  const double slow_begin = std::max(begin, 0.05) + kChange;
  const double slow_end = slow_begin + turn_length_m / slow;
  return world::SpeedProfile(
      {{std::max(begin, 0.05), fast}, {slow_begin, slow}, {slow_end, slow}, {slow_end + 2.0, fast}});
}

void add_walkers(world::World& world, const RoadUserShapes& shapes, const Junction& junction,
                 const SceneRequest& request) {
  const int count = static_cast<int>(6 * request.traffic);
  for (int i = 0; i < count; ++i) {
    const RandomSource own = request.random.fork(kWalkers).fork(static_cast<std::uint64_t>(i));
    const bool right_side = i % 2 == 0;
    const bool northwards = i % 4 < 2;
    // Each direction has its own line and its own speed, so that nobody is run into.
    const double middle = right_side ? kRightFront + 1.7 : kLeftFront - 1.6;
    const double lateral = middle + (northwards ? 0.4 : -0.4) + own.uniform(0, -0.05, 0.05);
    const double start = kHalfBlock + (right_side ? 22.0 : 14.0) + 7.0 * i;
    world::add_body(
        world, "pedestrian", shapes.pedestrian,
        world::drive(junction.second, world::SpeedProfile(northwards ? 1.3 : 1.1), {start, lateral, northwards}));
  }
}

void add_traffic(world::World& world, const Junction& junction, const SceneRequest& request,
                 const world::SpeedProfile& ego_speed) {
  const RoadUserShapes shapes = add_road_user_shapes(world);
  if (request.traffic <= 0.0) {
    return;
  }
  const RandomSource& random = request.random;
  // Turns ahead of the vehicle and keeps its distance.
  world::add_body(world, "car", shapes.car, world::drive(junction.drive, ego_speed, {17.0, 0.0, false}));
  constexpr double kCity = 8.0;  // m/s
  const double spacing = 32.0 / request.traffic;
  const int count = 2 + static_cast<int>(2.0 * request.traffic + kCity * request.duration_s / spacing);
  // Past the junction already, towards the vehicle.
  add_lane(world, shapes, junction.first, {kOtherLane, true, junction.x - 12.0, spacing, 1}, world::SpeedProfile(kCity),
           random.fork(kOncoming));
  // Crosses from south to north on the far lane of the second street, which the vehicle does not touch.
  add_lane(world, shapes, junction.second, {kOtherLane, true, kHalfBlock - 10.0, spacing, count},
           world::SpeedProfile(kCity), random.fork(kCrossing));
  // Ahead on the second street.
  add_lane(world, shapes, junction.second, {0.0, false, kHalfBlock + 60.0, 1.3 * spacing, 2},
           world::SpeedProfile(1.2 * std::max(request.speed_mps, 1.0)), random.fork(kAhead));
  add_walkers(world, shapes, junction, request);
}

}  // namespace

Scene build_city(const SceneRequest& request) {
  const double path_m = request.speed_mps * request.duration_s;
  const Junction junction = make_junction(path_m);
  const world::SpeedProfile speed = turning_speed(request.speed_mps, junction.turn_end_m - kApproach);
  Scene scene;
  add_statics(scene.world.statics, junction, path_m, request.random);
  add_traffic(scene.world, junction, request, speed);
  scene.vehicle = world::drive(junction.drive, speed, {}, world::spring_sway(1.0, request.random.fork(kEgoSway)));
  return scene;
}

}  // namespace dynamic_icp::scenes
