// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/datasets/layouts.hpp"
#include "dynamic_icp/recording/datasets/numbered_files.hpp"
#include "dynamic_icp/recording/datasets/record_dataset.hpp"
#include "dynamic_icp/recording/formats/tum.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScans = "point_clouds";

bool is_dicp(const fs::path& folder) { return holds_files(folder / kScans, ".bin"); }

/// The poses carry the stamps, one for each scan; those of the vehicle are taken to the sensor.
void read_poses(const fs::path& path, RecordRecording& recording) {
  formats::Trajectory poses = formats::read_tum(path).trajectory;
  if (poses.size() != recording.scans.files.size()) {
    throw DataError(fmt::format("{}: {} poses for {} scans, expected one pose per scan (they carry the time stamps)",
                                path.string(), poses.size(), recording.scans.files.size()));
  }
  for (formats::StampedPose& pose : poses) {
    pose.T_world_sensor = pose.T_world_sensor * recording.T_vehicle_sensor.value_or(Eigen::Isometry3d::Identity());
    recording.scans.stamps.push_back(pose.stamp);
  }
  recording.truth = {std::move(poses), path};
}

}  // namespace

fs::path find_dicp(const fs::path& input) {
  // Given the folder of the scans itself, its parent is meant.
  const fs::path whole = named_path(input);
  if (whole.filename() == kScans && is_dicp(whole.parent_path())) {
    return whole.parent_path();
  }
  return find_folder(input, is_dicp);
}

fs::path find_dicp_scans(const fs::path& input) {
  const fs::path folder = find_dicp(input);
  if (!folder.empty()) {
    return folder;
  }
  return holds_files(input, ".bin") ? input : find_folder(input, [](const fs::path& below) {
    return same_name(below, "velodyne") && holds_files(below, ".bin");
  });
}

Eigen::Isometry3d read_calibration(const fs::path& path) {
  // The file calls it T_V_to_S, but it is applied to points of the sensor to get points of the vehicle.
  try {
    const nlohmann::json calibration = nlohmann::json::parse(formats::read_text_file(path)).at("T_V_to_S");
    const nlohmann::json& t = calibration.at("translation");
    const nlohmann::json& q = calibration.at("quaternion");
    const Eigen::Quaterniond rotation(q.at("w").get<double>(), q.at("x").get<double>(), q.at("y").get<double>(),
                                      q.at("z").get<double>());
    if (std::abs(rotation.norm() - 1.0) > 1e-3) {
      throw DataError(fmt::format("{}: quaternion has length {:.4f}, expected 1", path.string(), rotation.norm()));
    }
    return Eigen::Translation3d(t.at("x").get<double>(), t.at("y").get<double>(), t.at("z").get<double>()) *
           rotation.normalized();
  } catch (const nlohmann::json::exception& error) {
    throw DataError(
        fmt::format("{}: expected {{\"T_V_to_S\": {{\"translation\": {{x, y, z}}, \"quaternion\": "
                    "{{w, x, y, z}}}}}}: {}",
                    path.string(), error.what()));
  }
}

std::unique_ptr<Dataset> open_dicp(const fs::path& folder, const OpenOptions& options) {
  RecordRecording recording;
  recording.format = "dicp";
  recording.layout_of = [](const fs::path&, Stamp) -> const formats::RecordLayout& { return formats::kXyzd; };
  if (fs::is_directory(folder / "times")) {
    recording.times = folder / "times";
  }
  if (const fs::path calibration = folder / "calibration.json"; fs::exists(calibration)) {
    recording.T_vehicle_sensor = read_calibration(calibration);
  }
  const fs::path scans = is_dicp(folder) ? folder / kScans : folder;
  if (const fs::path poses = folder / "ref_poses.txt"; fs::exists(poses)) {
    recording.scans.files = numbered_files(scans, ".bin");
    read_poses(poses, recording);
  } else {
    recording.scans = stamped_files(scans, ".bin", options.period_s);
    for (std::string& sentence : recording.scans.assumptions) {
      sentence = "no ref_poses.txt: " + sentence;
    }
  }
  return make_record_dataset(std::move(recording));
}

}  // namespace dynamic_icp::datasets
