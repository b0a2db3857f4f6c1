// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/calibration.hpp"
#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/datasets/foreign_numbers.hpp"
#include "dynamic_icp/recording/datasets/layouts.hpp"
#include "dynamic_icp/recording/datasets/numbered_files.hpp"
#include "dynamic_icp/recording/datasets/scan_stamps.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/point_records.hpp"
#include "dynamic_icp/recording/formats/record_file.hpp"
#include "dynamic_icp/recording/formats/tum.hpp"
#include "dynamic_icp/recording/formats/xyzd_bin.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScans = "point_clouds";

bool is_dicp(const fs::path& folder) { return holds_files(folder / kScans, ".bin"); }

/// Seconds after the stamp, one float32 per point. Our own addition to the layout, for scans that take time.
std::vector<double> read_times(const fs::path& path, const RawScan& scan, const fs::path& scan_file) {
  const std::size_t points = scan.points.size();
  formats::RecordFile file(path, sizeof(float));
  if (file.records() != points || (points > 0 && !file.warning().empty())) {
    // A scan that was cut has fewer points than it had times; so has one that is empty, or ends within a record.
    const bool is_cut = !scan.warning.empty() || points < file.records();
    throw DataError(is_cut ? fmt::format("{}: {} points, expected {} as there are times in {}: the scan is cut short{}",
                                         scan_file.string(), points, file.records(), path.string(),
                                         scan.warning.empty() ? "" : fmt::format(" ({})", scan.warning))
                           : fmt::format("{}: {} times for the {} points of {}, expected one float32 per point",
                                         path.string(), file.records(), points, scan_file.string()));
  }
  std::vector<double> times;
  times.reserve(points);
  for (std::string_view block = file.next(); !block.empty(); block = file.next()) {
    for (std::size_t at = 0; at < block.size(); at += sizeof(float)) {
      times.push_back(formats::value_at<float>(block, at));
    }
  }
  return times;
}

class DicpDataset final : public Dataset {
 public:
  DicpDataset(const fs::path& folder, const OpenOptions& options) {
    const fs::path scans = is_dicp(folder) ? folder / kScans : folder;
    if (fs::is_directory(folder / "times")) {
      times_ = folder / "times";
    }
    if (const fs::path calibration = folder / kCalibrationFile; fs::exists(calibration)) {
      take_calibration(calibration);
    }
    const fs::path poses = folder / "ref_poses.txt";
    if (fs::exists(poses)) {
      files_ = numbered_files(scans, ".bin");
      read_poses(poses);
      return;
    }
    StampedFiles stamped = stamped_files(scans, ".bin", options.period_s);
    files_ = std::move(stamped.files);
    stamps_ = std::move(stamped.stamps);
    for (const std::string& sentence : stamped.assumptions) {
      assumptions_.push_back("no ref_poses.txt: " + sentence);
    }
  }

  [[nodiscard]] std::string_view format() const override { return "dicp"; }
  [[nodiscard]] std::size_t size() const override { return files_.size(); }
  [[nodiscard]] Stamp stamp(std::size_t index) const override { return stamps_.at(index); }
  [[nodiscard]] fs::path scan_file(std::size_t index) const override { return files_.at(index); }
  [[nodiscard]] const formats::Trajectory& ground_truth() const override { return ground_truth_; }
  [[nodiscard]] fs::path ground_truth_file() const override { return ground_truth_file_; }
  [[nodiscard]] const std::vector<std::string>& assumptions() const override { return assumptions_; }

  [[nodiscard]] std::optional<Eigen::Isometry3d> T_vehicle_sensor() const override { return T_vehicle_sensor_; }

  [[nodiscard]] RawScan scan(std::size_t index) const override {
    RawScan raw = formats::read_xyzd(files_.at(index));
    refuse_foreign_numbers(raw, files_[index], formats::kXyzd);
    raw.stamp = stamps_[index];
    if (!times_.empty()) {
      raw.times = read_times(times_ / files_[index].filename(), raw, files_[index]);
    }
    return raw;
  }

 private:
  void take_calibration(const fs::path& path) {
    const Calibration calibration = read_calibration(path);
    T_vehicle_sensor_ = calibration.T_vehicle_sensor;
    if (!calibration.mountings.empty()) {
      assumptions_.push_back(
          fmt::format("{}: the mountings of its {} sensors are not used: no file says which of them measured a point",
                      path.string(), calibration.mountings.size()));
    }
  }

  void read_poses(const fs::path& poses) {
    ground_truth_ = formats::read_tum(poses).trajectory;
    if (ground_truth_.size() != files_.size()) {
      throw DataError(fmt::format("{}: {} poses for {} scans, expected one pose per scan (they carry the time stamps)",
                                  poses.string(), ground_truth_.size(), files_.size()));
    }
    for (formats::StampedPose& pose : ground_truth_) {
      pose.T_world_sensor = pose.T_world_sensor * T_vehicle_sensor_.value_or(Eigen::Isometry3d::Identity());
      stamps_.push_back(pose.stamp);
    }
    ground_truth_file_ = poses;
  }

  std::vector<fs::path> files_;
  fs::path times_;  ///< empty where the scans are instant
  std::vector<Stamp> stamps_;
  std::optional<Eigen::Isometry3d> T_vehicle_sensor_;
  formats::Trajectory ground_truth_;
  fs::path ground_truth_file_;
  std::vector<std::string> assumptions_;
};

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
  return std::make_unique<DicpDataset>(folder, options);
}

}  // namespace dynamic_icp::datasets
