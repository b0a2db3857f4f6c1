// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/raw_scan.hpp"
#include "dynamic_icp/method/motion/sweep_times.hpp"
#include "dynamic_icp/method/odometry/frame.hpp"
#include "dynamic_icp/recording/bags/mcap_writer.hpp"
#include "dynamic_icp/recording/formats/trajectory.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::runs {

/// The layout that shows the file of an McapRecorder well arranged in Foxglove and Lichtblick:
/// docs/foxglove_layout.json.
std::string_view foxglove_layout();
inline constexpr const char* kFoxgloveLayoutFile = "foxglove_layout.json";

/// Column `label` of the points, which are those of labels/*.bin but for the last one.
inline constexpr std::int32_t kLabelNotUsed = -1;
inline constexpr std::int32_t kLabelStatic = 0;   ///< and above it the id of an object
inline constexpr std::int32_t kLabelMoving = -2;  ///< by its Doppler, and of no object

struct McapRecorderSettings {
  motion::SweepConfig sweep;  ///< of the method: which times of points count
  bool tells_moving = true;   ///< whether the method tells moving points from static ones
  double period_s = 0.1;      ///< from scan to scan
  int threads = 0;            ///< 0: as many as the machine has
};

/// Writes what a run sees and finds, scan by scan and in bounded memory, as an MCAP file with Foxglove's schemas that
/// appears whole or not at all. The topics are those of docs/formats.md; every message has the stamp of its scan. All
/// in the frame `sensor`, whose pose in `world` is that of the trajectory.
///
/// Points that cannot be measurements are left out (Scan::from_raw); the others are where they would have been
/// measured at the stamp where the method deskews and states a twist, those of objects moved along with their object.
class McapRecorder {
 public:
  /// `truth` may be empty and must outlive the object. Throws DataError naming the file when it cannot be created.
  McapRecorder(const std::filesystem::path& file, const formats::Trajectory& truth, McapRecorderSettings settings);

  /// Throws DataError when the file cannot be written, or the stamp is before 1970.
  void add(const RawScan& raw, const odometry::Frame& frame);

  /// Writes what is left and gives the file its name.
  void commit();

 private:
  void write_points(const RawScan& raw, const odometry::Frame& frame);
  void write_path(const odometry::Frame& frame);
  void write_truth(const odometry::Frame& frame);
  void write_objects(const odometry::Frame& frame);
  void write_state(const odometry::Frame& frame);

  formats::StagedFile file_;
  bags::McapWriter writer_;
  const formats::Trajectory& truth_;
  McapRecorderSettings settings_;
  Workers workers_;
  std::uint16_t points_ = 0;
  std::uint16_t transforms_ = 0;
  std::uint16_t path_ = 0;
  std::uint16_t truth_path_ = 0;
  std::uint16_t objects_ = 0;
  std::uint16_t state_ = 0;
  std::vector<Eigen::Isometry3d> poses_;  ///< every `pose_stride_`-th of the run, few enough for a message
  std::size_t pose_stride_ = 1;
  std::size_t scans_ = 0;
  std::optional<Eigen::Isometry3d> T_world_truth_;  ///< makes the first pose equal to that of the ground truth
};

}  // namespace dynamic_icp::runs
