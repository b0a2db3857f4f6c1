// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/simulation/simulation.hpp"

#include <algorithm>
#include <cmath>

#include "dynamic_icp/base/error.hpp"

namespace dynamic_icp::simulation {
namespace {

/// What the seed decides.
enum Domain : std::uint64_t { kLayout, kNoise };

// A body whose middle moves slower than this and that turns slower than a tenth of it (rad/s) stands.
constexpr double kStandingSpeed = 0.01;  // m/s

void check(SimulationConfig config) {
  check_fields(fields(config));
  if (config.lidar.min_range_m >= config.lidar.max_range_m) {
    throw UsageError("configuration key 'lidar.min_range_m' must be below 'lidar.max_range_m'");
  }
}

bool moves(const MotionState& body, const Eigen::Vector3d& center_world) {
  return point_velocity(body, center_world).norm() > kStandingSpeed ||
         body.angular_velocity_world.norm() > 0.1 * kStandingSpeed;
}

/// The truth about one body seen from the sensor; `points` is left at 0.
ObjectTruth object_truth(const World& world, const MovingBody& body, const MotionState& motion,
                         const MotionState& sensor) {
  const Eigen::AlignedBox3d box = bounds(world.shapes[body.shape]);
  const Eigen::Isometry3d T_sensor_world = sensor.T_world_body.inverse();
  const Eigen::Vector3d center_world = motion.T_world_body * box.center();
  ObjectTruth object;
  object.id = body.id;
  object.name = body.name;
  object.T_sensor_body = T_sensor_world * motion.T_world_body;
  object.center_sensor = T_sensor_world * center_world;
  object.size = box.sizes();
  object.velocity_sensor = T_sensor_world.linear() * point_velocity(motion, center_world);
  object.yaw_rate_rps = motion.angular_velocity_world.z();
  return object;
}

}  // namespace

ConfigFields fields(SimulationConfig& config) {
  ConfigFields list = {
      {"frames", &config.frames, 1, 1e6, "", "number of scans"},
      {"seed", &config.seed, 0, 1e9, "", "decides on layout, traffic and noise"},
      {"speed_mps", &config.speed_mps, 0.0, 70.0, "m/s", "mean speed of the vehicle"},
      {"traffic", &config.traffic, 0.0, 3.0, "", "density of moving road users: 0 none, 1 usual"},
  };
  append_fields(list, "lidar", fields(config.lidar));
  append_fields(list, "mount", fields(config.mount));
  return list;
}

SimulationConfig default_config(const SceneKind& kind) {
  SimulationConfig config;
  config.speed_mps = kind.speed_mps;
  return config;
}

Scene build_scene(const SceneKind& kind, const SimulationConfig& config) {
  check(config);
  const RandomSource random(static_cast<std::uint64_t>(config.seed));
  return kind.build({config.speed_mps, config.traffic, config.frames / config.lidar.rate_hz, random.fork(kLayout)});
}

Simulation::Simulation(const SceneKind& kind, const SimulationConfig& config)
    : kind_(kind),
      config_(config),
      scene_(build_scene(kind, config)),
      caster_(scene_.world),
      pattern_(instant_pattern(config_.lidar)),
      noise_(RandomSource(static_cast<std::uint64_t>(config.seed)).fork(kNoise)) {
  sensor_ = [vehicle = scene_.vehicle, T = T_vehicle_sensor(config_.mount)](double time_s) {
    return mounted(vehicle(time_s), T);
  };
}

Simulation::~Simulation() = default;

Stamp Simulation::stamp(std::size_t index) const {
  return {std::llround(static_cast<double>(index) * 1e9 / config_.lidar.rate_hz)};
}

SimulatedFrame Simulation::frame(std::size_t index, const Workers& workers) const {
  SimulatedFrame frame;
  frame.index = index;
  frame.scan = simulate_scan({scene_.world, caster_, sensor_}, pattern_, config_.lidar, stamp(index),
                             noise_.fork(index), workers);
  const double time_s = seconds_between(Stamp{}, stamp(index));
  const MotionState sensor = sensor_(time_s);
  const Eigen::Matrix3d R_sensor_world = sensor.T_world_body.linear().transpose();
  frame.T_world_sensor = sensor.T_world_body;
  frame.velocity_sensor = R_sensor_world * sensor.velocity_world;
  frame.angular_velocity_sensor = R_sensor_world * sensor.angular_velocity_world;

  std::vector<std::size_t> points(scene_.world.bodies.size() + 1, 0);
  for (const std::int32_t id : frame.scan.bodies) {
    ++points[static_cast<std::size_t>(id)];
  }
  for (const MovingBody& body : scene_.world.bodies) {
    const std::size_t count = points[static_cast<std::size_t>(body.id)];
    const MotionState motion = body.trajectory(time_s);
    ObjectTruth object = object_truth(scene_.world, body, motion, sensor);
    object.points = count;
    if (count > 0 && moves(motion, sensor.T_world_body * object.center_sensor)) {
      frame.objects.push_back(object);
    }
  }
  return frame;
}

}  // namespace dynamic_icp::simulation
