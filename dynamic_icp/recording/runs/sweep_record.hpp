// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "dynamic_icp/method/motion/sweep_times.hpp"
#include "dynamic_icp/method/odometry/frame.hpp"
#include "dynamic_icp/recording/diagnosis/sweep_search.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::runs {

/// What was found and done about the time that scans take: as in the first usable scan, and whether the others agree.
struct SweepRecord {
  std::optional<motion::SweepReport> first;
  bool same_times = true;
  bool all_deskewed = true;
  std::optional<diagnosis::SweepSearch> search;  ///< of points without times, where the run asked for it

  void add(const odometry::Frame& frame, const RawScan& scan);
  /// What was added.
  void state(StateArchive& archive);
  [[nodiscard]] bool deskewed() const { return first && all_deskewed; }
  /// "in the data", "declared", "found" by the search, "none" or "mixed".
  [[nodiscard]] std::string times() const;
  [[nodiscard]] std::optional<double> duration_s() const { return first ? first->duration_s : std::nullopt; }
};

}  // namespace dynamic_icp::runs
