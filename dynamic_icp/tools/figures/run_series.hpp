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

/// All that the run has values for, in this order: ego_speed, translation_error, rotation_error, position_error, nees
/// (with ground truth), innovation, iterations, inlier_rmse, fitness, degeneracy, dynamic_share, objects, milliseconds.
///
/// `innovation` compares the motion into a frame with the twist of the frame before, kept: e^T (dt^2 C_twist +
/// C_motion)^-1 e, rotation and translation apart. It is 3 on average where the velocity does not change; manoeuvres
/// and jumps exceed that.
std::vector<RunSeries> run_series(const runs::RunFiles& run, const std::optional<RunTruth>& truth);

}  // namespace dynamic_icp::figures
