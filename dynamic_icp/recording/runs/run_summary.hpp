// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dynamic_icp/method/odometry/frame.hpp"
#include "dynamic_icp/recording/evaluation/run_accuracy.hpp"

namespace dynamic_icp::runs {

/// What summary.json says of a run. Ratios and times are over the frames they exist for; empty where there is none.
struct RunSummary {
  std::string method;
  std::size_t frames = 0;
  evaluation::RunAccuracy accuracy;        ///< empty numbers without ground truth
  std::optional<double> mean_iterations;   ///< over aligned pairs
  std::optional<double> convergence_rate;  ///< converged pairs over all pairs
  std::optional<double> ms_mean;
  std::optional<double> ms_median;
  std::optional<double> ms_p95;
  std::optional<double> fps;                 ///< 1000 / ms_mean
  std::optional<double> dynamic_ratio_mean;  ///< dynamic candidates over points used
  std::optional<double> dynamic_ratio_max;
  std::optional<double> clustered_ratio_mean;  ///< clustered over dynamic candidates
  std::optional<double> refined_ratio_mean;    ///< in an accepted object over clustered, as the paper tabulates it
  std::vector<std::string> assumptions;        ///< what had to be taken for granted about recording and method
  std::array<std::size_t, odometry::kVerdicts.size()> verdicts{};      ///< frames per word of odometry::kVerdicts
  std::vector<std::pair<odometry::FrameStatus, std::size_t>> reasons;  ///< frames per reason, as they first occurred
  std::string failure;      ///< "ODOMETRY FAILED on ...: cause" where most scans are lost, else empty
  bool stopped = false;     ///< asked to, before its last scan
  std::string no_accuracy;  ///< why there is none where the ground truth does not fit, else empty
};

/// The content of summary.json.
std::string summary_json(const RunSummary& summary);

}  // namespace dynamic_icp::runs
