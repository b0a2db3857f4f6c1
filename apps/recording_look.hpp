// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"

// What `info` sees of a recording before the diagnosis.
namespace dynamic_icp::apps {

/// When the scans are.
struct TimesSeen {
  std::size_t periods = 0;  ///< from one scan to the next
  double period_s = 0.0;    ///< median
  double shortest_s = 0.0;
  double longest_s = 0.0;
  std::vector<std::pair<std::size_t, double>> gaps;  ///< the scan after each, and how long it was, s
};

TimesSeen look_at_times(const datasets::Dataset& dataset);

/// What some scans spread over the recording hold.
struct PointsSeen {
  std::size_t scans = 0;
  std::vector<std::size_t> sizes;  ///< ascending
  Scan::Dropped dropped;
  double nearest_m = std::numeric_limits<double>::infinity();
  double farthest_m = 0.0;
  double slowest_mps = std::numeric_limits<double>::infinity();
  double fastest_mps = -std::numeric_limits<double>::infinity();
  bool times = false;
  std::vector<std::string> columns;
  std::vector<std::string> warnings;
  std::vector<Eigen::Isometry3d> mountings;  ///< T_scan_sensor of the sensors of a rig

  /// Whether any point was usable, so that there are ranges.
  [[nodiscard]] bool any() const { return farthest_m > 0.0; }
};

PointsSeen look_at_points(const datasets::Dataset& dataset);

}  // namespace dynamic_icp::apps
