// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "dynamic_icp/base/config_field.hpp"
#include "dynamic_icp/base/parallel.hpp"
#include "dynamic_icp/simulation/fmcw_lidar.hpp"
#include "dynamic_icp/simulation/scan_simulation.hpp"
#include "dynamic_icp/simulation/scene.hpp"

namespace dynamic_icp::simulation {

/// A simulated drive: scene, knobs and sensor.
struct SimulationConfig {
  int frames = 60;
  int seed = 1;
  double speed_mps = 13.0;
  double traffic = 1.0;
  FmcwLidarConfig lidar;
  MountConfig mount;
};

ConfigFields fields(SimulationConfig& config);

/// The defaults for this kind of scene.
SimulationConfig default_config(const SceneKind& kind);

/// The scene of this configuration, without a sensor. Throws UsageError when a setting is out of range.
Scene build_scene(const SceneKind& kind, const SimulationConfig& config);

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

/// One scan with the whole truth about it; sensor and bodies as they are at the scan's stamp.
struct SimulatedFrame {
  std::size_t index = 0;
  SimulatedScan scan;
  Eigen::Isometry3d T_world_sensor;         ///< world: the scene's frame
  Eigen::Vector3d velocity_sensor;          ///< m/s, of the sensor over ground, along the sensor's axes
  Eigen::Vector3d angular_velocity_sensor;  ///< rad/s, along the sensor's axes
  std::vector<ObjectTruth> objects;         ///< bodies that move now and gave at least one return
};

/// A scene that is ready to be scanned. Any frame can be made at any time, on its own.
class Simulation {
 public:
  /// Builds the scene. Throws UsageError when a setting is out of range.
  Simulation(const SceneKind& kind, const SimulationConfig& config);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(config_.frames); }
  [[nodiscard]] const SceneKind& kind() const { return kind_; }
  [[nodiscard]] const SimulationConfig& config() const { return config_; }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const RayCaster& caster() const { return caster_; }

  /// The motion of the sensor frame.
  [[nodiscard]] const Trajectory& sensor() const { return sensor_; }

  /// When a scan begins: whole nanoseconds, 0 for the first.
  [[nodiscard]] Stamp stamp(std::size_t index) const;

  /// Makes one scan. The bits depend on scene, configuration and index only.
  [[nodiscard]] SimulatedFrame frame(std::size_t index, const Workers& workers) const;

 private:
  SceneKind kind_;
  SimulationConfig config_;
  Scene scene_;
  RayCaster caster_;
  Trajectory sensor_;
  ScanPattern pattern_;
  RandomSource noise_;
};

}  // namespace dynamic_icp::simulation
