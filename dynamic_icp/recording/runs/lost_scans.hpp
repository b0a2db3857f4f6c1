// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dynamic_icp/method/odometry/frame.hpp"
#include "dynamic_icp/recording/runs/scan_record.hpp"

namespace dynamic_icp::runs {

/// The exit status of the program where a run failed so: its results are there, but the trajectory is a guess.
inline constexpr int kMostScansLost = 3;

/// The lost scans of a run (odometry::verdict), and what they have in common.
class LostScans {
 public:
  void add(const ScanRecord& scan);

  /// "ODOMETRY FAILED on 273 of 274 scans: 41 points a scan give no planes" where more than half of the scans are lost:
  /// the trajectory is a guess then. Nothing otherwise. The cause is that of most of the lost scans.
  [[nodiscard]] std::optional<std::string> failure() const;

 private:
  /// What is known of the scans that were lost for one reason.
  struct Reason {
    std::vector<double> points;       ///< as read
    std::vector<double> points_used;  ///< of those
    std::vector<double> intervals_s;  ///< since the scan before
    Scan::Dropped dropped;
  };

  [[nodiscard]] static std::string cause(odometry::FrameStatus status, const Reason& reason);

  std::size_t scans_ = 0;
  std::size_t lost_ = 0;
  std::optional<Stamp> last_;
  std::map<odometry::FrameStatus, Reason> reasons_;
};

}  // namespace dynamic_icp::runs
