// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/base/stamp.hpp"
#include "dynamic_icp/method/odometry/frame.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::runs {

/// The file with a ScanRecord for each scan, beside the checkpoint. A run that is complete has none.
inline constexpr const char* kScanRecordsFile = "checkpoint.scans";

/// What the trajectory and the summary of a run need of one scan. In a file, not in memory, which stays the same
/// however long the run is.
struct ScanRecord {
  odometry::FrameStatus status = odometry::FrameStatus::kNotRun;
  Stamp stamp;
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();
  std::optional<Matrix6d> covariance;  ///< registration::Alignment::covariance
  bool is_aligned = false;             ///< an alignment was tried
  int iterations = 0;                  ///< of it
  std::size_t points = 0;              ///< this and the next as in odometry::Frame
  std::size_t points_used = 0;
  Scan::Dropped dropped;
  std::size_t dynamic_candidates = 0;
  std::size_t dynamic_clustered = 0;
  std::size_t dynamic_refined = 0;
  double total_ms = 0.0;

  void state(StateArchive& archive);
};

ScanRecord scan_record(const odometry::Frame& frame);

/// As it stands in the file: as many bytes for each, a checksum among them.
std::string record_bytes(ScanRecord record);

/// The length of the file with this many of them.
std::uintmax_t record_file_bytes(std::size_t records);

/// Calls `use` for each record of a file in turn and says how many there are. Throws DataError naming the file where it
/// is cut off or damaged.
std::size_t for_each_record(const std::filesystem::path& path,
                            const std::function<void(const ScanRecord& record)>& use);

}  // namespace dynamic_icp::runs
