// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/config_field.hpp"

namespace dynamic_icp::preprocess {

/// What is done about the time a scan takes.
struct SweepConfig {
  bool undo = true;                     ///< off: every scan counts as taken at its stamp (ablation "no-deskew")
  double declared_duration_s = 0.0;     ///< where points have no times: the scan takes so long, column by column; 0: no
  bool declared_left_to_right = false;  ///< order of these columns; off: from right to left, azimuth growing
};

ConfigFields fields(SweepConfig& config);

/// Times (s after the stamp) of points of a scan whose columns were measured one after the other at an even rate: the
/// azimuth atan2(y, x) from one end of the scan to the other is the time. The x axis must look into the scan, so that
/// it does not reach across the back.
std::vector<double> declared_times(std::span<const Eigen::Vector3d> points, const SweepConfig& config);

}  // namespace dynamic_icp::preprocess
