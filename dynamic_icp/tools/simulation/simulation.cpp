// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::simulation {
namespace {

// Forks of the seed, besides that of the layout.
constexpr std::uint64_t kNoise = 1;
constexpr std::uint64_t kVibration = 2;

// A body whose middle moves slower than this and that turns slower than a tenth of it (rad/s) stands.
constexpr double kStandingSpeed = 0.01;  // m/s

bool moves(const world::MotionState& body, const Eigen::Vector3d& center_world) {
  return world::point_velocity(body, center_world).norm() > kStandingSpeed ||
         body.angular_velocity_world.norm() > 0.1 * kStandingSpeed;
}

/// The truth about one body seen from the sensor; `points` is left at 0.
ObjectTruth object_truth(const world::World& world, const world::MovingBody& body, const world::MotionState& motion,
                         const Eigen::Isometry3d& T_world_sensor) {
  const Eigen::AlignedBox3d box = world.shapes[body.shape].box;
  const Eigen::Isometry3d T_sensor_world = T_world_sensor.inverse();
  const Eigen::Vector3d center_world = motion.T_world_body * box.center();
  ObjectTruth object;
  object.id = body.id;
  object.name = body.name;
  object.T_sensor_body = T_sensor_world * motion.T_world_body;
  object.center_sensor = T_sensor_world * center_world;
  object.size = box.sizes();
  object.velocity_sensor = T_sensor_world.linear() * world::point_velocity(motion, center_world);
  object.yaw_rate_rps = motion.angular_velocity_world.z();
  return object;
}

/// `config` when everything in it is possible.
SimulationConfig checked(SimulationConfig config) {
  check_fields(fields(config));
  check(config.rig);
  return config;
}

double rate_hz(const SimulationConfig& config) { return config.rig.sensors.front().lidar.rate_hz; }

}  // namespace

ConfigFields fields(SimulationConfig& config) {
  ConfigFields list = {{"frames", &config.frames, 1, 1e6, "", "number of scans"}};
  for (const ConfigField& field : scenes::fields(config.scene)) {
    list.push_back(field);
  }
  append_fields(list, "vibration", world::fields(config.rig.vibration));
  return list;
}

void set(SimulationConfig& config, std::string_view key, std::string_view text) {
  const bool of_all_sensors = key.starts_with("lidar.") || key.starts_with("mount.");
  bool is_set = false;
  for (SensorConfig& sensor : config.rig.sensors) {
    const bool of_this = key.starts_with(sensor.name + ".");
    if (of_this || of_all_sensors) {
      set_field(fields(sensor), of_all_sensors ? key : key.substr(sensor.name.size() + 1), text);
      is_set = true;
    }
  }
  if (!is_set) {
    set_field(fields(config), key, text);
  }
}

SimulationConfig default_config(const scenes::SceneKind& kind) {
  SimulationConfig config;
  config.scene = scenes::default_knobs(kind);
  config.rig = find_rig(std::string(kDefaultRig));
  return config;
}

Simulation::Simulation(const scenes::SceneKind& kind, const SimulationConfig& config)
    : kind_(kind),
      config_(checked(config)),
      // The last scan takes time, too.
      scene_(scenes::build_scene(kind, config.scene, config.frames / rate_hz(config))),
      caster_(scene_.world),
      noise_(RandomSource(static_cast<std::uint64_t>(config.scene.seed)).fork(kNoise)) {
  const std::vector<SensorConfig>& sensors = config_.rig.sensors;
  scene_.vehicle =
      world::vibrating(std::move(scene_.vehicle), T_vehicle_sensor(sensors.front().mount), config_.rig.vibration,
                       RandomSource(static_cast<std::uint64_t>(config.scene.seed)).fork(kVibration));
  for (const SensorConfig& sensor : sensors) {
    sensors_.emplace_back([vehicle = scene_.vehicle, T = T_vehicle_sensor(sensor.mount)](double time_s) {
      return world::mounted(vehicle(time_s), T);
    });
    units_.emplace_back(sensor.lidar, sensor.name);
    patterns_.push_back(scan_pattern(sensor.lidar));
  }
}

Simulation::~Simulation() = default;

Stamp Simulation::stamp(std::size_t index) const {
  return {std::llround(static_cast<double>(index) * 1e9 / rate_hz(config_))};
}

ScanTime Simulation::scan_time(std::size_t index, std::size_t sensor) const {
  return simulation::scan_time(units_.at(sensor).config.timing, stamp(index), 1.0 / rate_hz(config_),
                               noise_.fork(sensor).fork(index));
}

SensorState Simulation::sensor_state(double time_s, std::size_t sensor) const {
  const world::MotionState motion = sensors_.at(sensor)(time_s);
  const Eigen::Matrix3d R_sensor_world = motion.T_world_body.linear().transpose();
  return {motion.T_world_body, R_sensor_world * motion.velocity_world, R_sensor_world * motion.angular_velocity_world};
}

ObjectTruth Simulation::object(std::int32_t id, double time_s, std::size_t sensor) const {
  const std::vector<world::MovingBody>& bodies = scene_.world.bodies;
  const world::MovingBody& body =
      *std::find_if(bodies.begin(), bodies.end(), [&](const world::MovingBody& one) { return one.id == id; });
  return object_truth(scene_.world, body, body.trajectory(time_s), sensor_state(time_s, sensor).T_world_sensor);
}

SimulatedFrame Simulation::frame(std::size_t index, const Workers& workers, std::size_t sensor) const {
  const ScanTime time = scan_time(index, sensor);
  const double time_s = seconds_between(Stamp{}, time.begin);
  SimulatedFrame frame;
  frame.index = index;
  frame.begin = time.begin;
  frame.sensor = sensor_state(time_s, sensor);
  const RandomSource noise = noise_.fork(sensor);
  const SensorUnit& unit = units_[sensor];
  const double drift_mps = unit.doppler.drift_mps(index, 1.0 / rate_hz(config_), noise);
  frame.scan = simulate_scan({scene_.world, caster_, sensors_.at(sensor)}, patterns_[sensor], unit,
                             {time.begin, index, drift_mps}, noise.fork(index), workers);
  frame.scan.measured.stamp = time.stamp;

  std::vector<std::size_t> points(scene_.world.bodies.size() + 1, 0);
  for (const std::int32_t id : frame.scan.bodies) {
    points[static_cast<std::size_t>(std::max(id, 0))] += 1;
  }
  for (const world::MovingBody& body : scene_.world.bodies) {
    const std::size_t count = points[static_cast<std::size_t>(body.id)];
    const world::MotionState motion = body.trajectory(time_s);
    ObjectTruth object = object_truth(scene_.world, body, motion, frame.sensor.T_world_sensor);
    object.points = count;
    if (count > 0 && moves(motion, frame.sensor.T_world_sensor * object.center_sensor)) {
      frame.objects.push_back(object);
    }
  }
  return frame;
}

}  // namespace dynamic_icp::simulation
