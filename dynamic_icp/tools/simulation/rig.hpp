// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/tools/simulation/fmcw_lidar.hpp"
#include "dynamic_icp/tools/simulation/mount.hpp"
#include "dynamic_icp/tools/world/vibration.hpp"

namespace dynamic_icp::simulation {

/// One sensor on the vehicle.
struct SensorConfig {
  std::string name;
  FmcwLidarConfig lidar;
  MountConfig mount;
};

ConfigFields fields(SensorConfig& sensor);

/// The sensors of a vehicle. All make their scans at the same rate, each beginning `lidar.timing.start_s` late.
struct Rig {
  std::string name;
  std::string description;
  world::VibrationConfig vibration;   ///< of the vehicle's body with all sensors, about the first one
  std::vector<SensorConfig> sensors;  ///< at least one; names differ
};

/// A rig that comes with the program, as the text of its YAML file (docs/simulator.md describes the layout).
struct RigPreset {
  std::string_view name;
  std::string_view yaml;
};

const std::vector<RigPreset>& rig_presets();

/// The rig that is used when none is named.
constexpr std::string_view kDefaultRig = "aeries-ii";

/// The preset of that name or, where `name` ends in .yaml or .yml, the rig of that file. Throws UsageError with the
/// known names, or with file, line and valid range when a value is wrong; DataError when the file cannot be read.
Rig find_rig(const std::string& name);

/// Reads a rig from YAML; `origin` names it in messages.
Rig parse_rig(std::string_view yaml, const std::filesystem::path& origin);

/// The same rig without any error, and at rest on its vehicle.
Rig without_noise(Rig rig);

/// Throws UsageError when a sensor or the vibration is impossible, names are not usable as folders or rates differ.
void check(const Rig& rig);

}  // namespace dynamic_icp::simulation
