// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/sequence_writer.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::simulation {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::array<std::pair<std::string_view, Layout>, 5> kLayouts = {{{"dicp", Layout::kDicp},
                                                                          {"hercules", Layout::kHercules},
                                                                          {"helipr", Layout::kHelipr},
                                                                          {"boreas", Layout::kBoreas},
                                                                          {"aevascenes", Layout::kAevaScenes}}};

std::string_view name_of(Layout layout) {
  return std::find_if(kLayouts.begin(), kLayouts.end(), [&](const auto& known) { return known.second == layout; })
      ->first;
}

Json settings(const ConfigFields& fields) {
  Json json = Json::object();
  for (const ConfigField& field : fields) {
    std::visit([&](const auto* value) { json[field.key] = *value; }, field.value);
  }
  return json;
}

Json rig_json(const Rig& rig) {
  Json sensors = Json::array();
  for (SensorConfig sensor : rig.sensors) {
    Json json = {{"name", sensor.name}};
    json.update(settings(fields(sensor)));
    sensors.push_back(json);
  }
  return {{"name", rig.name}, {"sensors", sensors}};
}

/// Stamp 0 of the simulation in the files of a layout.
std::int64_t epoch_ns(Layout layout) {
  if (layout == Layout::kDicp) {
    return 0;
  }
  return layout == Layout::kHelipr ? kHeliprTimeOfStart : kUnixTimeOfStart;
}

/// The points of one sensor; nothing for layouts that hold all sensors together.
std::unique_ptr<PointLayout> make_layout(Layout layout, const fs::path& folder, const Simulation& simulation,
                                         bool takes_time) {
  switch (layout) {
    case Layout::kDicp:
      return make_dicp_layout(folder, takes_time);
    case Layout::kHercules:
      return make_hercules_layout(folder);
    case Layout::kHelipr:
      return make_helipr_layout(folder, simulation);
    case Layout::kBoreas:
      return make_boreas_layout(folder);
    case Layout::kAevaScenes:
      break;
  }
  return nullptr;
}

/// Where the truth of a sensor lies.
fs::path folder_of(const fs::path& folder, const Rig& rig, std::size_t sensor) {
  return rig.sensors.size() == 1 ? folder : folder / rig.sensors[sensor].name;
}

}  // namespace

Layout find_layout(std::string_view name) {
  const auto* const found =
      std::find_if(kLayouts.begin(), kLayouts.end(), [&](const auto& known) { return known.first == name; });
  if (found == kLayouts.end()) {
    throw UsageError(fmt::format("unknown layout '{}', expected dicp, hercules, helipr, boreas or aevascenes", name));
  }
  return found->second;
}

SequenceWriter::SequenceWriter(const fs::path& folder, const Simulation& simulation, const SequenceOptions& options)
    : folder_(folder), simulation_(simulation), options_(options) {
  if (options.calibration && options.layout != Layout::kDicp) {
    throw UsageError(fmt::format("calibration.json belongs to the layout dicp, not to {}", name_of(options.layout)));
  }
  const Rig& rig = simulation.config().rig;
  const TruthOptions truth{epoch_ns(options.layout), options.calibration, options.point_truth};
  for (std::size_t sensor = 0; sensor < rig.sensors.size(); ++sensor) {
    const fs::path own = folder_of(folder, rig, sensor);
    formats::make_folder(own);
    truth_.push_back(std::make_unique<TruthWriter>(own, simulation, sensor, truth));
    if (auto points = make_layout(options.layout, own, simulation, rig.sensors[sensor].lidar.sweep_s > 0.0)) {
      points_.push_back(std::move(points));
    }
  }
  if (options.layout == Layout::kAevaScenes) {
    points_.push_back(make_aevascenes_layout(folder, simulation));
  }
}

void SequenceWriter::add(const SimulatedFrame& frame, std::size_t sensor) {
  points_[points_.size() == 1 ? 0 : sensor]->add(frame, sensor);
  truth_.at(sensor)->add(frame);
  const auto count_kind = [&](ReturnKind kind) {
    return static_cast<std::size_t>(std::count(frame.scan.kinds.begin(), frame.scan.kinds.end(), kind));
  };
  const FmcwLidarConfig& lidar = simulation_.config().rig.sensors[sensor].lidar;
  ++counts_.scans;
  counts_.rays += static_cast<std::size_t>(lidar.columns) * static_cast<std::size_t>(lidar.rows);
  counts_.points += frame.scan.bodies.size();
  counts_.mixed_points += count_kind(ReturnKind::kMixed);
  counts_.rain_points += count_kind(ReturnKind::kRain);
  counts_.false_points +=
      count_kind(ReturnKind::kSpray) + count_kind(ReturnKind::kWindow) + count_kind(ReturnKind::kGhost);
  counts_.objects += frame.objects.size();
  for (const ObjectTruth& object : frame.objects) {
    counts_.moving_points += object.points;
  }
  if (sensor == 0) {
    const Eigen::Vector3d position = frame.sensor.T_world_sensor.translation();
    counts_.path_length_m += last_position_ ? (position - *last_position_).norm() : 0.0;
    last_position_ = position;
  }
}

void SequenceWriter::finish(std::string_view version) {
  for (const auto& points : points_) {
    points->finish();
  }
  for (const auto& truth : truth_) {
    truth->finish();
  }
  SimulationConfig config = simulation_.config();
  const world::World& world = simulation_.scene().world;
  const Json json = {{"scene", simulation_.kind().name},
                     {"description", simulation_.kind().description},
                     {"version", version},
                     {"settings", settings(fields(config))},
                     {"rig", rig_json(config.rig)},
                     {"layout", name_of(options_.layout)},
                     {"scans", counts_.scans},
                     {"rays", counts_.rays},
                     {"points", counts_.points},
                     {"moving_points", counts_.moving_points},
                     {"mixed_points", counts_.mixed_points},
                     {"rain_points", counts_.rain_points},
                     {"false_points", counts_.false_points},
                     {"path_length_m", counts_.path_length_m},
                     {"static_triangles", world.statics.triangles.size()},
                     {"moving_bodies", world.bodies.size()}};
  formats::write_whole_file(folder_ / "scene.json", json.dump(2) + "\n");
}

}  // namespace dynamic_icp::simulation
