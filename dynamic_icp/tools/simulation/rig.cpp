// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/rig.hpp"

#include <algorithm>
#include <cctype>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/nearest_key.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/recording/formats/yaml_map.hpp"

namespace dynamic_icp::simulation {
namespace {

/// Names become folders and parts of file names.
bool is_usable_name(const std::string& name) {
  return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
}

SensorConfig read_sensor(const formats::YamlMap& map) {
  SensorConfig sensor;
  sensor.name = map.text("name");
  if (!is_usable_name(sensor.name)) {
    map.fail("name", fmt::format("is '{}', expected 1 to 64 letters, digits, '_' or '-'", sensor.name));
  }
  map.settings("mount", fields(sensor.mount));
  map.settings("lidar", fields(sensor.lidar));
  try {
    check(sensor.lidar);
  } catch (const UsageError& error) {
    map.fail("lidar", fmt::format("is impossible: {}", error.what()));
  }
  return sensor;
}

bool is_file_name(const std::string& name) { return name.ends_with(".yaml") || name.ends_with(".yml"); }

}  // namespace

ConfigFields fields(SensorConfig& sensor) {
  ConfigFields list;
  append_fields(list, "lidar", fields(sensor.lidar));
  append_fields(list, "mount", fields(sensor.mount));
  return list;
}

Rig without_noise(Rig rig) {
  rig.vibration = {};
  for (SensorConfig& sensor : rig.sensors) {
    sensor.lidar = without_noise(sensor.lidar);
  }
  return rig;
}

void check(const Rig& rig) {
  if (rig.sensors.empty()) {
    throw UsageError(fmt::format("rig '{}' has no sensor", rig.name));
  }
  world::check(rig.vibration);
  std::set<std::string> names;
  for (SensorConfig sensor : rig.sensors) {
    if (!is_usable_name(sensor.name) || !names.insert(sensor.name).second) {
      throw UsageError(fmt::format("rig '{}': sensor name '{}' is not usable or used twice", rig.name, sensor.name));
    }
    check_fields(fields(sensor.mount));
    check(sensor.lidar);
    const double rate_hz = rig.sensors.front().lidar.rate_hz;
    if (sensor.lidar.rate_hz != rate_hz) {
      throw UsageError(fmt::format("rig '{}': sensor '{}' makes {:g} scans a second, expected {:g} as the first sensor",
                                   rig.name, sensor.name, sensor.lidar.rate_hz, rate_hz));
    }
  }
}

Rig parse_rig(std::string_view yaml, const std::filesystem::path& origin) {
  const formats::YamlMap map = formats::YamlMap::parse(yaml, origin);
  Rig rig;
  rig.name = origin.stem().string();
  rig.description = map.text("description", "");
  map.settings("vibration", world::fields(rig.vibration));
  for (const formats::YamlMap& sensor : map.list("sensors")) {
    rig.sensors.push_back(read_sensor(sensor));
  }
  map.finish();
  try {
    check(rig);
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{}: {}", origin.string(), error.what()));
  }
  return rig;
}

Rig find_rig(const std::string& name) {
  if (is_file_name(name)) {
    return parse_rig(formats::read_text_file(name), name);
  }
  std::vector<std::string> names;
  for (const RigPreset& preset : rig_presets()) {
    if (preset.name == name) {
      return parse_rig(preset.yaml, fmt::format("{}.yaml", name));
    }
    names.emplace_back(preset.name);
  }
  throw UsageError(fmt::format("unknown sensor '{}'{}; expected a sensor file (*.yaml) or one of: {}", name,
                               did_you_mean(name, names), fmt::join(names, ", ")));
}

}  // namespace dynamic_icp::simulation
