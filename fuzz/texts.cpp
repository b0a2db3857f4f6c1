// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT

#include <algorithm>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/calibration.hpp"
#include "dynamic_icp/recording/datasets/layouts.hpp"

#include "fuzz/memory_file.hpp"

namespace {

using namespace dynamic_icp;

bool is_rigid(const Eigen::Isometry3d& T) {
  return T.matrix().allFinite() && (T.linear().transpose() * T.linear() - Eigen::Matrix3d::Identity()).norm() < 1e-6;
}

void read_mountings(const std::filesystem::path& path) {
  const datasets::Calibration calibration = datasets::read_calibration(path);
  fuzz::must(calibration.T_vehicle_sensor || !calibration.mountings.empty());
  fuzz::must(!calibration.T_vehicle_sensor || is_rigid(*calibration.T_vehicle_sensor));
  fuzz::must(std::all_of(calibration.mountings.begin(), calibration.mountings.end(), is_rigid));
  const datasets::Calibration again = datasets::parse_calibration(datasets::calibration_text(calibration), "again");
  fuzz::must(again.mountings.size() == calibration.mountings.size());
  fuzz::must(again.T_vehicle_sensor.has_value() == calibration.T_vehicle_sensor.has_value());
}

void find_mountings(const fuzz::MemoryFile& input) {
  std::vector<std::string> assumptions;
  const std::filesystem::path folder = input.named(datasets::kCalibrationFile).parent_path();
  fuzz::must(datasets::find_calibration(folder, assumptions).has_value() || !assumptions.empty());
}

void read_poses(const std::filesystem::path& path) {
  const formats::Trajectory poses = datasets::read_boreas_poses(path);
  fuzz::must(!poses.empty());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    fuzz::must(is_rigid(poses[i].T_world_sensor));
    fuzz::must(i == 0 || poses[i - 1].stamp < poses[i].stamp);
  }
}

void read_times(const std::filesystem::path& path) {
  const std::vector<Stamp> stamps = datasets::read_boreas_times(path);
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    fuzz::must(stamps[i - 1] < stamps[i]);
  }
}

}  // namespace

// The small texts beside the scans, by the first byte: any bytes are read as what the text means, or refused with a
// DataError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  try {
    const fuzz::MemoryFile input(data + 1, size - 1);
    switch (static_cast<unsigned char>(data[0] - '0') % 6) {
      case 0:
        read_poses(input.path());
        break;
      case 1:
        read_times(input.path());
        break;
      case 2:
        fuzz::must(is_rigid(datasets::read_boreas_matrix(input.path())));
        break;
      case 3:
        fuzz::must(is_rigid(datasets::read_imu_lidar(input.path())));
        break;
      case 4:
        read_mountings(input.path());
        break;
      default:
        find_mountings(input);
    }
  } catch (const DataError&) {
  }
  return 0;
}
