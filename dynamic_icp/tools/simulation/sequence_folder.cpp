// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/sequence_folder.hpp"

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/version.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/tools/simulation/overview.hpp"

namespace dynamic_icp::simulation {
namespace {

namespace fs = std::filesystem;
using SceneJson = nlohmann::json;

/// A picture of the scan in the middle of the drive.
void write_overview(const Simulation& simulation, const fs::path& path, const Workers& workers) {
  const SimulatedFrame frame = simulation.frame(simulation.size() / 2, workers);
  formats::write_whole_file(path, draw_overview(simulation, frame, drawing::Ground::kLight, workers));
}

/// What the marker of a result says; nothing when it cannot be read: then nothing but the usual files is known.
SceneJson content_of(const fs::path& marker) {
  try {
    const SceneJson content = SceneJson::parse(formats::read_text_file(marker));
    return content.is_object() ? content : SceneJson::object();
  } catch (const std::exception&) {
    return SceneJson::object();
  }
}

/// The files of one sensor, below the folder that holds them.
void append_sensor_files(const std::string& folder, std::vector<std::string>& files) {
  for (const char* name :
       {"ref_poses.txt", "ego.jsonl", "motion.csv", "objects.jsonl", "calibration.json", "stamps.csv", "labels/#.bin",
        "truth/#.bin", "doppler_error/#.bin", "point_clouds/#.bin", "times/#.bin", "LiDAR/Aeva/#.bin",
        "PR_GT/Aeva_gt.txt", "LiDAR_GT/Aeva_gt.txt", "aeva/#.bin", "applanix/aeva_poses.csv"}) {
    files.push_back(folder + name);
  }
}

std::vector<std::string> sequence_files(const fs::path& folder) {
  std::vector<std::string> files = {"scene.json", "overview.svg", "sequence.json"};
  append_sensor_files("", files);
  const SceneJson sensors =
      content_of(folder / "scene.json").value(SceneJson::json_pointer("/rig/sensors"), SceneJson::array());
  for (const SceneJson& sensor : sensors) {
    if (sensor.is_object() && sensor.contains("name") && sensor["name"].is_string()) {
      const std::string name = sensor["name"];
      append_sensor_files(name + "/", files);
      files.push_back("pointcloud_raw/" + name + "_#.npz");
      files.push_back("pointcloud_compensated/" + name + "_#.npz");
    }
  }
  return files;
}

}  // namespace

SequenceCounts write_sequence(const Simulation& simulation, const SequenceOptions& options, const fs::path& folder,
                              const Workers& workers, const std::function<void()>& progress) {
  SequenceWriter writer(folder, simulation, options);
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    for (std::size_t sensor = 0; sensor < simulation.config().rig.sensors.size(); ++sensor) {
      if (!simulation.scan_time(i, sensor).missing) {
        writer.add(simulation.frame(i, workers, sensor), sensor);
      }
    }
    if (progress) {
      progress();
    }
  }
  writer.finish(version());
  write_overview(simulation, folder / "overview.svg", workers);
  return writer.counts();
}

formats::ResultKind sequence_result() { return {"scene.json", sequence_files}; }

}  // namespace dynamic_icp::simulation
