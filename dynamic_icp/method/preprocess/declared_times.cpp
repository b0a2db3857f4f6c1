// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/preprocess/declared_times.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dynamic_icp::preprocess {

ConfigFields fields(SweepConfig& config) {
  return {
      {"undo", &config.undo, 0, 0, "", "undo the motion during a scan where the times of its points are known"},
      {"declared_duration_s", &config.declared_duration_s, 0.0, 10.0, "s",
       "where points have no times: the scan takes so long, column by column at an even rate; 0: taken at its stamp"},
      {"declared_left_to_right", &config.declared_left_to_right, 0, 0, "",
       "these columns run from left to right; off: from right to left"},
  };
}

std::vector<double> declared_times(std::span<const Eigen::Vector3d> points, const SweepConfig& config) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  std::vector<double> times;
  times.reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    const double azimuth = std::atan2(point.y(), point.x());
    times.push_back(azimuth);
    if (std::isfinite(azimuth)) {
      low = std::min(low, azimuth);
      high = std::max(high, azimuth);
    }
  }
  const double width = high > low ? high - low : 1.0;
  for (double& time : times) {
    const double share = std::isfinite(time) ? (time - low) / width : 0.0;  // such points are dropped later
    time = config.declared_duration_s * (config.declared_left_to_right ? 1.0 - share : share);
  }
  return times;
}

}  // namespace dynamic_icp::preprocess
