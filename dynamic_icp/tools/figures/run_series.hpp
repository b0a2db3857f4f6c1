// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/recording/runs/run_folder.hpp"
#include "dynamic_icp/tools/figures/run_context.hpp"
#include "dynamic_icp/tools/figures/series_plot.hpp"

namespace dynamic_icp::figures {

/// What there is to plot of a run over time, one value a frame.
struct RunSeries {
  std::string id;    ///< see `run_series`
  std::string unit;  ///< of the values
  Panel panel;
};

/// All that the run has values for, in this order: ego_speed, translation_error, rotation_error (with ground truth),
/// iterations, inlier_rmse, fitness, degeneracy, dynamic_share, objects, milliseconds.
std::vector<RunSeries> run_series(const runs::RunFiles& run, const std::optional<RunTruth>& truth);

}  // namespace dynamic_icp::figures
