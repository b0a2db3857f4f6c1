// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/calibration.hpp"
#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/datasets/layouts.hpp"
#include "dynamic_icp/recording/datasets/numbered_files.hpp"
#include "dynamic_icp/recording/datasets/pose_file.hpp"
#include "dynamic_icp/recording/datasets/record_dataset.hpp"
#include "dynamic_icp/recording/datasets/record_shape.hpp"
#include "dynamic_icp/recording/datasets/stated_records.hpp"
#include "dynamic_icp/recording/datasets/truth_search.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScans = "point_clouds";

bool is_dicp(const fs::path& folder) { return holds_files(folder / kScans, ".bin"); }

/// The poses, one for each scan, carry the stamps where they have some; those of the vehicle are taken to the sensor.
void read_poses(const fs::path& path, const fs::path& scans, double period_s, RecordRecording& recording) {
  PoseFile file = read_pose_file(path);
  if (file.has_stamps) {
    recording.scans.files = numbered_files(scans, ".bin");
  } else {
    recording.scans = stamped_files(scans, ".bin", period_s);
  }
  if (file.poses.size() != recording.scans.files.size()) {
    throw DataError(fmt::format("{}: {} poses for {} scans, expected one pose per scan{}", path.string(),
                                file.poses.size(), recording.scans.files.size(),
                                file.has_stamps ? " (they carry the time stamps)" : ""));
  }
  for (std::size_t i = 0; i < file.poses.size(); ++i) {
    formats::StampedPose& pose = file.poses[i];
    pose.T_world_sensor = pose.T_world_sensor * recording.T_vehicle_sensor.value_or(Eigen::Isometry3d::Identity());
    if (file.has_stamps) {
      recording.scans.stamps.push_back(pose.stamp);
    } else {
      pose.stamp = recording.scans.stamps[i];
    }
  }
  recording.truth = {std::move(file.poses), path};
}

/// Files and stamps of the scans, with the poses where there are any.
void find_scans(const fs::path& folder, const OpenOptions& options, RecordRecording& recording) {
  const fs::path scans = is_dicp(folder) ? folder / kScans : folder;
  if (const fs::path poses = folder / "ref_poses.txt"; fs::exists(poses)) {
    read_poses(poses, scans, options.period_s, recording);
    return;
  }
  recording.scans = stamped_files(scans, ".bin", options.period_s);
  for (std::string& sentence : recording.scans.assumptions) {
    sentence = "no ref_poses.txt: " + sentence;
  }
  recording.truth = take_truth(folder, recording.scans);
}

}  // namespace

fs::path find_dicp(const fs::path& input) {
  // Given the folder of the scans itself, its parent is meant.
  const fs::path whole = named_path(input);
  if (whole.filename() == kScans && is_dicp(whole.parent_path())) {
    return whole.parent_path();
  }
  // One of the scans is a recording of it alone.
  if (whole.parent_path().filename() == kScans && whole.extension() == ".bin" && fs::is_regular_file(whole)) {
    return whole;
  }
  return find_folder(input, is_dicp);
}

fs::path find_dicp_scans(const fs::path& input) {
  if (fs::is_regular_file(input)) {
    return input;
  }
  const fs::path folder = find_dicp(input);
  if (!folder.empty()) {
    return folder;
  }
  return holds_files(input, ".bin") ? input : find_folder(input, [](const fs::path& below) {
    return same_name(below, "velodyne") && holds_files(below, ".bin");
  });
}

std::unique_ptr<Dataset> open_dicp(const fs::path& found, const OpenOptions& options) {
  const bool is_scan = fs::is_regular_file(found);
  const fs::path beside = is_scan ? named_path(found).parent_path() : found;
  const fs::path folder = is_scan && beside.filename() == kScans ? beside.parent_path() : beside;
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
  if (is_scan) {
    recording.scans = stamped_files({found}, options.period_s);
  } else {
    find_scans(folder, options, recording);
  }
  recording.scans.assumptions.insert(recording.scans.assumptions.begin(), assumptions.begin(), assumptions.end());
  if (states_records(options)) {
    read_as_stated(options, recording);
  } else if (const auto other = other_shape(recording.scans.files, 4, formats::NumberType::kFloat32)) {
    throw *other;
  }
  return make_record_dataset(std::move(recording));
}

}  // namespace dynamic_icp::datasets
