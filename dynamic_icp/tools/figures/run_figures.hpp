// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dynamic_icp/recording/runs/run_folder.hpp"
#include "dynamic_icp/tools/drawing/svg.hpp"
#include "dynamic_icp/tools/drawing/theme.hpp"
#include "dynamic_icp/tools/figures/paper.hpp"
#include "dynamic_icp/tools/figures/run_context.hpp"

namespace dynamic_icp::figures {

struct Figure {
  std::string name;  ///< "scan", "trajectory", "errors", "speed", "dynamics", "convergence", "timing", "doppler_error"
  drawing::Svg svg;
};

/// The figures of a run in the order of that list, without those that have nothing to show: no "scan" when the
/// recording is gone, no "errors" without ground truth, no "doppler_error" where none was learned.
std::vector<Figure> draw_figures(const runs::RunFiles& run, const RunContext& context, const drawing::Theme& theme,
                                 Medium medium = Medium::kScreen);

/// A run among others over the same recording.
struct ComparedRun {
  std::string name;
  runs::RunFiles files;
  std::optional<RunTruth> truth;
};

/// "trajectory", "errors" (with ground truth), "convergence" and "timing" of several runs in common pictures. They must
/// begin with the same scan: the first pose of each is the identity.
std::vector<Figure> draw_comparison(const std::vector<ComparedRun>& runs, const drawing::Theme& theme,
                                    Medium medium = Medium::kScreen);

}  // namespace dynamic_icp::figures
