// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "benchmarks/kernels/scans.hpp"

#include <array>
#include <memory>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/ego_motion/velocity_filter.hpp"
#include "dynamic_icp/method/odometry/config.hpp"
#include "dynamic_icp/tools/scenes/scene.hpp"
#include "dynamic_icp/tools/simulation/simulation.hpp"

namespace dynamic_icp::kernels {
namespace {

constexpr std::size_t kFirstScan = 20;

struct Grid {
  int columns;
  int rows;
};

constexpr std::array<Grid, kSensors> kGrids = {{{450, 24}, {1200, 64}, {3400, 160}}};

std::unique_ptr<simulation::Simulation> make_simulation(Sensor sensor) {
  const scenes::SceneKind& kind = scenes::find_scene("city");
  simulation::SimulationConfig config = simulation::default_config(kind);
  config.frames = 40;
  config.scene.seed = 31;
  simulation::FmcwLidarConfig& lidar = config.rig.sensors.front().lidar;
  lidar = simulation::instant(lidar);
  lidar.doppler_noise_mps = 0.05;
  lidar.doppler_outlier_rate = 0.005;
  lidar.dropout_rate = 0.03;
  lidar.columns = kGrids[static_cast<std::size_t>(sensor)].columns;
  lidar.rows = kGrids[static_cast<std::size_t>(sensor)].rows;
  return std::make_unique<simulation::Simulation>(kind, config);
}

const simulation::Simulation& simulated(Sensor sensor) {
  static std::array<std::unique_ptr<simulation::Simulation>, kSensors> all;
  auto& one = all.at(static_cast<std::size_t>(sensor));
  if (!one) {
    one = make_simulation(sensor);
  }
  return *one;
}

/// The points that do not move, for a mask over the same scan.
Scan still_part(const Scan& scan, const std::vector<std::uint8_t>& is_moving) {
  std::vector<std::uint32_t> rows;
  for (std::uint32_t row = 0; row < scan.size(); ++row) {
    if (is_moving[row] == 0) {
      rows.push_back(row);
    }
  }
  return scan.select(rows);
}

KnownScan make_scan(Sensor sensor, std::size_t index) {
  const odometry::WindowOdometryConfig config;
  const auto moving = [&](const Scan& scan, const Eigen::Vector3d& velocity) {
    return ego_motion::dynamic_mask(scan, ego_motion::compensated_doppler(scan, velocity), config.ego_motion.filter);
  };
  simulation::SimulatedFrame frame = simulated(sensor).frame(kFirstScan + index, Workers(0));
  KnownScan known;
  known.raw = std::move(frame.scan.measured);
  known.raw.times.clear();  // instant scans have none
  known.velocity_sensor = frame.sensor.velocity_sensor;
  known.T_world_sensor = frame.sensor.T_world_sensor;
  known.whole = preprocess::crop_range(Scan::from_raw(known.raw), config.preprocess.range);
  known.thinned = preprocess::voxel_grid(known.whole, config.preprocess.voxel);
  known.radial = ego_motion::compensated_doppler(known.whole, known.velocity_sensor);
  known.is_moving = moving(known.whole, known.velocity_sensor);
  known.still = still_part(known.thinned, moving(known.thinned, known.velocity_sensor));
  return known;
}

}  // namespace

const KnownScan& known_scan(Sensor sensor, std::size_t index) {
  static std::array<std::array<std::unique_ptr<KnownScan>, kScans>, kSensors> all;
  auto& one = all.at(static_cast<std::size_t>(sensor)).at(index);
  if (!one) {
    one = std::make_unique<KnownScan>(make_scan(sensor, index));
  }
  return *one;
}

std::vector<Eigen::Vector3d> spread_points(std::size_t count) {
  const std::vector<Eigen::Vector3d>& all = known_scan(Sensor::kLarge).raw.points;
  if (count > all.size()) {
    throw std::invalid_argument("the large scan has fewer points");
  }
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back(all[i * all.size() / count]);
  }
  return points;
}

std::vector<Eigen::Vector3d> still_in_world(const KnownScan& scan) {
  std::vector<Eigen::Vector3d> points = scan.still.points();
  for (Eigen::Vector3d& point : points) {
    point = scan.T_world_sensor * point;
  }
  return points;
}

const mapping::PlaneMap& known_map() {
  static const mapping::PlaneMap map = [] {
    mapping::PlaneMap made(odometry::WindowOdometryConfig{}.mapping);
    for (std::size_t i = 0; i + 1 < kScans; ++i) {
      const KnownScan& scan = known_scan(Sensor::kUsual, i);
      made.add(still_in_world(scan), scan.T_world_sensor.translation(), Workers(0));
    }
    return made;
  }();
  return map;
}

}  // namespace dynamic_icp::kernels
