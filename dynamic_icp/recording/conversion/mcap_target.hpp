// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "dynamic_icp/recording/bags/mcap_writer.hpp"
#include "dynamic_icp/recording/conversion/scan_table.hpp"
#include "dynamic_icp/recording/datasets/calibration.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/formats/trajectory.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::conversion {

/// The names in a converted recording; docs/formats.md describes them.
inline constexpr const char* kMcapPoints = "/points";
inline constexpr const char* kMcapCompensatedPoints = "/points_compensated";  ///< by this the reader knows it
inline constexpr const char* kMcapTruthPose = "/ground_truth/pose";
inline constexpr const char* kMcapTruthPath = "/ground_truth/path";
inline constexpr const char* kMcapTransforms = "/tf";
inline constexpr const char* kMcapStaticTransforms = "/tf_static";
inline constexpr const char* kMcapCalibration = "/calibration";
inline constexpr const char* kMcapCalibrationType = "dynamic_icp.Calibration";

/// A recording as one MCAP file, which appears whole or not at all: every scan as a foxglove.PointCloud with all of its
/// columns, the ground truth as poses, as a path and as transforms, the mountings as transforms and, exactly, as the
/// text of a calibration.json. Messages lie in the order of their times.
class McapTarget {
 public:
  /// `dataset` and `calibration` must outlive the object. Throws DataError naming the file when it cannot be created.
  McapTarget(const std::filesystem::path& file, const datasets::Dataset& dataset,
             const datasets::Calibration& calibration);

  /// Appends a scan, and the poses of the ground truth until then.
  void add(Stamp stamp, const ScanToWrite& scan, Notes& notes);

  /// Writes what is left and gives the file its name.
  void finish(Notes& notes);

 private:
  void write_start(Stamp stamp);
  void write_truth_until(std::optional<Stamp> end, Notes& notes);

  formats::StagedFile file_;
  bags::McapWriter writer_;
  const formats::Trajectory& truth_;
  const datasets::Calibration& calibration_;
  std::size_t next_pose_ = 0;
  bool started_ = false;
  std::uint16_t points_ = 0;
  std::uint16_t truth_pose_ = 0;
  std::uint16_t truth_path_ = 0;
  std::uint16_t transforms_ = 0;
  std::uint16_t static_transforms_ = 0;
  std::uint16_t calibration_channel_ = 0;
};

}  // namespace dynamic_icp::conversion
