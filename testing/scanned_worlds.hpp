// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "dynamic_icp/tools/simulation/mount.hpp"
#include "dynamic_icp/tools/simulation/scan_simulation.hpp"
#include "dynamic_icp/tools/world/drive.hpp"

// For tests: small worlds with a sensor in them, and statistics of what it measures.
namespace dynamic_icp::simulation {

using Eigen::Vector3d;

/// A room around a sensor that drives, turns and nods in it, with a spinning, drifting box in front.
struct Room {
  world::World world;
  std::unique_ptr<world::RayCaster> caster;
  world::Trajectory sensor;
  FmcwLidarConfig config;

  Room() {
    world.statics = world::make_box({60.0, 50.0, 20.0});
    add_shape(world, world::make_box({4.0, 2.0, 3.0}));
    world::add_body(world, "box", 0, [](double t) {
      world::MotionState state;
      state.T_world_body.translation() << 12.0 + 2.0 * t, 1.0 - 3.0 * t, 0.5;
      state.T_world_body.linear() = Eigen::AngleAxisd(1.5 * t, Vector3d::UnitZ()).toRotationMatrix();
      state.velocity_world << 2.0, -3.0, 0.0;
      state.angular_velocity_world << 0.0, 0.0, 1.5;
      return state;
    });
    caster = std::make_unique<world::RayCaster>(world);
    const auto route = std::make_shared<const world::Route>(std::vector<world::RoutePiece>{{60.0, 0.05, 0.05}});
    const world::Trajectory vehicle =
        world::drive(route, world::SpeedProfile(9.0), {}, [](double t, const world::PlanarState&) {
          return world::Sway{0.1 * std::sin(t), 0.05 * std::sin(2.0 * t), 0.0,
                             0.1 * std::cos(t), 0.1 * std::cos(2.0 * t),  0.0};
        });
    MountConfig mount{1.5, 0.7, 1.9, 6.0, -4.0, 12.0};
    sensor = [vehicle, T = T_vehicle_sensor(mount)](double t) { return world::mounted(vehicle(t), T); };
    config.columns = 120;
    config.rows = 16;
  }

  [[nodiscard]] SimulatedScan scan(const ScanPattern& pattern, std::int64_t stamp_ns = 300'000'000,
                                   int threads = 1) const {
    return simulate_scan({world, *caster, sensor}, pattern, SensorUnit(config), {Stamp{stamp_ns}}, RandomSource(9),
                         Workers(threads));
  }
};

/// A sensor at rest before one large wall across its view; `slant_deg` turns the wall.
struct Wall {
  world::World world;
  std::unique_ptr<world::RayCaster> caster;
  world::Trajectory sensor = [](double) { return world::MotionState{}; };
  FmcwLidarConfig config;

  Wall(double distance_m, double reflectivity, double slant_deg = 0.0) {
    const Eigen::AngleAxisd slant(slant_deg * std::numbers::pi / 180.0, Vector3d::UnitZ());
    append(world.statics, world::painted(world::make_box({0.2, 2000.0, 2000.0}), reflectivity),
           Eigen::Translation3d(distance_m, 0.0, 0.0) * slant);
    caster = std::make_unique<world::RayCaster>(world);
    // A narrow view: every ray meets the wall at nearly the same range and angle.
    config.horizontal_fov_deg = 1.0;
    config.vertical_fov_deg = 1.0;
    config.columns = 200;
    config.rows = 100;
    config.max_range_m = 2000.0;
  }

  [[nodiscard]] SimulatedScan scan() const {
    return simulate_scan({world, *caster, sensor}, scan_pattern(config), SensorUnit(config), {}, RandomSource(3),
                         Workers(2));
  }
  [[nodiscard]] double share() const { return static_cast<double>(scan().bodies.size()) / 20000.0; }
};

/// Sum, mean and standard deviation of numbers.
struct Statistics {
  double n = 0.0;
  double sum = 0.0;
  double squares = 0.0;

  void add(double x) {
    n += 1.0;
    sum += x;
    squares += x * x;
  }
  [[nodiscard]] double mean() const { return sum / n; }
  [[nodiscard]] double deviation() const { return std::sqrt(std::max(0.0, squares / n - mean() * mean())); }
};

/// Four standard errors of a share measured on n things.
inline double share_error(double share, double n) { return 4.0 * std::sqrt(share * (1.0 - share) / n); }

}  // namespace dynamic_icp::simulation
