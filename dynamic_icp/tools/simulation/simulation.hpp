// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/tools/scenes/scene.hpp"
#include "dynamic_icp/tools/simulation/rig.hpp"
#include "dynamic_icp/tools/simulation/scan_simulation.hpp"

namespace dynamic_icp::simulation {

/// A simulated drive: scene, knobs and sensors.
struct SimulationConfig {
  int frames = 60;
  scenes::SceneKnobs scene;
  Rig rig;
};

/// The settings that are not of a sensor.
ConfigFields fields(SimulationConfig& config);

/// Sets one of them, or one of all sensors ("lidar.rows", "mount.z_m"), or of the sensor that the key begins with
/// ("left.lidar.rows"). Throws UsageError as set_field does.
void set(SimulationConfig& config, std::string_view key, std::string_view text);

/// The defaults for this kind of scene, with the default rig.
SimulationConfig default_config(const scenes::SceneKind& kind);

/// The truth about a moving body in one scan.
struct ObjectTruth {
  std::int32_t id = 0;
  std::string name;
  Eigen::Isometry3d T_sensor_body;
  Eigen::Vector3d center_sensor;    ///< m, of its box
  Eigen::Vector3d size;             ///< m, of its box along the body's axes
  Eigen::Vector3d velocity_sensor;  ///< m/s, of the box's centre over ground, along the sensor's axes
  double yaw_rate_rps = 0.0;        ///< rad/s, about the world's vertical
  std::size_t points = 0;           ///< returns on it in this scan
};

/// Where the sensor is and how it moves at one time.
struct SensorState {
  Eigen::Isometry3d T_world_sensor;         ///< world: the scene's frame
  Eigen::Vector3d velocity_sensor;          ///< m/s, of the sensor over ground, along the sensor's axes
  Eigen::Vector3d angular_velocity_sensor;  ///< rad/s, along the sensor's axes
};

/// One scan of one sensor with the whole truth about it; sensor and bodies as they are at the scan's begin.
struct SimulatedFrame {
  std::size_t index = 0;
  Stamp begin;  ///< on the clock of the drive; `scan.measured.stamp` is what the sensor says
  SimulatedScan scan;
  SensorState sensor;
  std::vector<ObjectTruth> objects;  ///< bodies that move now and gave at least one return
};

/// A scene that is ready to be scanned. Any frame can be made at any time, on its own.
class Simulation {
 public:
  /// Builds the scene. Throws UsageError when a setting is out of range.
  Simulation(const scenes::SceneKind& kind, const SimulationConfig& config);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(config_.frames); }
  [[nodiscard]] const scenes::SceneKind& kind() const { return kind_; }
  [[nodiscard]] const SimulationConfig& config() const { return config_; }
  [[nodiscard]] const scenes::Scene& scene() const { return scene_; }
  [[nodiscard]] const world::RayCaster& caster() const { return caster_; }

  /// The motion of a sensor's frame.
  [[nodiscard]] const world::Trajectory& sensor(std::size_t sensor = 0) const { return sensors_.at(sensor); }
  [[nodiscard]] SensorState sensor_state(double time_s, std::size_t sensor = 0) const;

  /// The truth about a moving body seen from a sensor at any time; `points` is 0. The body must exist.
  [[nodiscard]] ObjectTruth object(std::int32_t id, double time_s, std::size_t sensor = 0) const;

  /// When a scan is due: whole nanoseconds, 0 for the first.
  [[nodiscard]] Stamp stamp(std::size_t index) const;

  /// When a sensor begins a scan, what stamp it gives it, and whether the scan is lost.
  [[nodiscard]] ScanTime scan_time(std::size_t index, std::size_t sensor = 0) const;

  /// Makes one scan of one sensor, lost or not. The bits depend on scene, configuration, index and sensor only.
  [[nodiscard]] SimulatedFrame frame(std::size_t index, const Workers& workers, std::size_t sensor = 0) const;

 private:
  scenes::SceneKind kind_;
  SimulationConfig config_;
  scenes::Scene scene_;
  world::RayCaster caster_;
  std::vector<world::Trajectory> sensors_;
  std::vector<SensorUnit> units_;
  std::vector<ScanPattern> patterns_;
  RandomSource noise_;
};

}  // namespace dynamic_icp::simulation
