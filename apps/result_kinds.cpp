// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/result_kinds.hpp"

#include <nlohmann/json.hpp>

#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// What the marker of a result says; nothing when it cannot be read: then nothing but the usual files is known.
json content_of(const fs::path& marker) {
  try {
    const json content = json::parse(formats::read_text_file(marker));
    return content.is_object() ? content : json::object();
  } catch (const std::exception&) {
    return json::object();
  }
}

std::vector<std::string> conversion_files(const fs::path& /*folder*/) {
  return {"conversion.json", "ref_poses.txt", "calibration.json", "point_clouds/#.bin", "times/#.bin", "#.npz",
          "#.pcd",           "#.ply",         "recording.mcap"};
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
  const json sensors = content_of(folder / "scene.json").value("/rig/sensors"_json_pointer, json::array());
  for (const json& sensor : sensors) {
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

formats::ResultKind conversion_result() { return {"conversion.json", conversion_files}; }

formats::ResultKind sequence_result() { return {"scene.json", sequence_files}; }

}  // namespace dynamic_icp::apps
