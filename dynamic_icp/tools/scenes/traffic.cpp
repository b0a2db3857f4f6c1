// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/scenes/traffic.hpp"

#include <utility>
#include <vector>

#include "dynamic_icp/tools/world/body_shapes.hpp"

namespace dynamic_icp::scenes {
RoadUserShapes add_road_user_shapes(world::World& world) {
  RoadUserShapes shapes;
  shapes.car = add_shape(world, world::make_car());
  shapes.van = add_shape(world, world::make_van());
  shapes.truck = add_shape(world, world::make_truck());
  shapes.tractor = add_shape(world, world::make_tractor());
  shapes.semitrailer = add_shape(world, world::make_semitrailer());
  shapes.trailer = add_shape(world, world::make_trailer());
  shapes.pedestrian = add_shape(world, world::make_pedestrian());
  return shapes;
}

void add_tractor_with_semitrailer(world::World& world, const RoadUserShapes& shapes, const world::Trajectory& tractor,
                                  double end_s) {
  const std::int32_t id = world::add_body(world, "tractor", shapes.tractor, tractor);
  world::add_body(world, "semitrailer", shapes.semitrailer, world::tow(tractor, world::kSemitrailerHitch, end_s));
  world.bodies.back().towed_by = id;
}

void add_truck_with_trailer(world::World& world, const RoadUserShapes& shapes, const world::Trajectory& truck,
                            double end_s) {
  const std::int32_t id = world::add_body(world, "truck", shapes.truck, truck);
  world::add_body(world, "trailer", shapes.trailer, world::tow(truck, world::kTrailerHitch, end_s));
  world.bodies.back().towed_by = id;
}

void add_lane(world::World& world, const RoadUserShapes& shapes, const std::shared_ptr<const world::Route>& route,
              const Lane& lane, const world::SpeedProfile& speed, const RandomSource& random) {
  for (int i = 0; i < lane.count; ++i) {
    const RandomSource own = random.fork(static_cast<std::uint64_t>(i));
    const double jitter = own.uniform(0, -0.1, 0.1) * lane.spacing_m;
    const world::RouteFollowing following{lane.first_m + i * lane.spacing_m + jitter, lane.lateral_m, lane.against};
    const world::Trajectory trajectory = world::drive(route, speed, following);
    if (own.uniform(1) < lane.truck_share) {
      world::add_body(world, "truck", shapes.truck, trajectory);
    } else if (own.uniform(2) < 0.2) {
      world::add_body(world, "van", shapes.van, trajectory);
    } else {
      world::add_body(world, "car", shapes.car, trajectory);
    }
  }
}

}  // namespace dynamic_icp::scenes
