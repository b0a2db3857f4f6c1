// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/simulation/traffic.hpp"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "dynamic_icp/simulation/body_shapes.hpp"

namespace dynamic_icp::simulation {
namespace {

using std::numbers::pi;

}  // namespace

RoadUserShapes add_road_user_shapes(World& world) {
  RoadUserShapes shapes;
  const auto add = [&](TriangleMesh mesh) {
    world.shapes.push_back(std::move(mesh));
    return world.shapes.size() - 1;
  };
  shapes.car = add(make_car());
  shapes.van = add(make_van());
  shapes.truck = add(make_truck());
  shapes.pedestrian = add(make_pedestrian());
  return shapes;
}

void add_lane(World& world, const RoadUserShapes& shapes, const std::shared_ptr<const Route>& route, const Lane& lane,
              const SpeedProfile& speed, const RandomSource& random) {
  for (int i = 0; i < lane.count; ++i) {
    const RandomSource own = random.fork(static_cast<std::uint64_t>(i));
    const double jitter = own.uniform(0, -0.1, 0.1) * lane.spacing_m;
    const RouteFollowing following{lane.first_m + i * lane.spacing_m + jitter, lane.lateral_m, lane.against};
    const Trajectory trajectory = drive(route, speed, following);
    if (own.uniform(1) < lane.truck_share) {
      add_body(world, "truck", shapes.truck, trajectory);
    } else if (own.uniform(2) < 0.2) {
      add_body(world, "van", shapes.van, trajectory);
    } else {
      add_body(world, "car", shapes.car, trajectory);
    }
  }
}

SwayFunction spring_sway(double scale, const RandomSource& random) {
  struct Wave {
    double amplitude;
    double omega;
    double phase;

    [[nodiscard]] double value(double t) const { return amplitude * std::sin(omega * t + phase); }
    [[nodiscard]] double rate(double t) const { return amplitude * omega * std::cos(omega * t + phase); }
  };
  const auto wave = [&](std::uint64_t stream, double amplitude, double low_hz, double high_hz) {
    return Wave{scale * amplitude, 2.0 * pi * random.uniform(2 * stream, low_hz, high_hz),
                random.uniform(2 * stream + 1, 0.0, 2.0 * pi)};
  };
  constexpr double kDegree = pi / 180.0;
  const Wave heave = wave(0, 0.012, 0.9, 1.4);
  const Wave pitch = wave(1, 0.4 * kDegree, 0.6, 1.1);
  const Wave roll = wave(2, 0.4 * kDegree, 0.4, 0.8);
  return [heave, pitch, roll](double t, const PlanarState&) {
    return Sway{heave.value(t), pitch.value(t), roll.value(t), heave.rate(t), pitch.rate(t), roll.rate(t)};
  };
}

SpeedProfile wandering_speed(double mean_mps, double share, double duration_s, const RandomSource& random) {
  constexpr double kKnotSpacing = 2.5;  // s
  std::vector<SpeedKnot> knots;
  for (int i = 0; i * kKnotSpacing <= duration_s + kKnotSpacing; ++i) {
    const double wander = random.uniform(static_cast<std::uint64_t>(i), -share, share);
    knots.push_back({i * kKnotSpacing, mean_mps * (1.0 + wander)});
  }
  return SpeedProfile(std::move(knots));
}

}  // namespace dynamic_icp::simulation
