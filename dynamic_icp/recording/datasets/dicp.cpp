// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/calibration.hpp"
#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/datasets/layouts.hpp"
#include "dynamic_icp/recording/datasets/numbered_files.hpp"
#include "dynamic_icp/recording/datasets/record_dataset.hpp"
#include "dynamic_icp/recording/formats/tum.hpp"

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

std::unique_ptr<Dataset> open_dicp(const fs::path& folder, const OpenOptions& options) {
  RecordRecording recording;
  recording.format = "dicp";
  recording.layout_of = [](const fs::path&, Stamp) -> const formats::RecordLayout& { return formats::kXyzd; };
  if (fs::is_directory(folder / "times")) {
    recording.times = folder / "times";
  }
  std::vector<std::string> assumptions;
  if (const fs::path path = folder / kCalibrationFile; fs::exists(path)) {
    const Calibration calibration = read_calibration(path);
    recording.T_vehicle_sensor = calibration.T_vehicle_sensor;
    if (!calibration.mountings.empty()) {
      assumptions.push_back(
          fmt::format("{}: the mountings of its {} sensors are not used: no file says which of them measured a point",
                      path.string(), calibration.mountings.size()));
    }
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
  recording.scans.assumptions.insert(recording.scans.assumptions.begin(), assumptions.begin(), assumptions.end());
  return make_record_dataset(std::move(recording));
}

}  // namespace dynamic_icp::datasets
