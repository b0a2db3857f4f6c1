// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/figures/run_figures.hpp"

#include <algorithm>
#include <string_view>

#include "dynamic_icp/figures/run_series.hpp"
#include "dynamic_icp/figures/scan_plot.hpp"
#include "dynamic_icp/figures/series_plot.hpp"
#include "dynamic_icp/figures/trajectory_plot.hpp"

namespace dynamic_icp::figures {
namespace {

/// The figures over time, with the series that share each of them.
constexpr struct {
  const char* name;
  std::string_view series[2];
} kOverTime[] = {{"errors", {"translation_error", "rotation_error"}},
                 {"speed", {"ego_speed"}},
                 {"dynamics", {"dynamic_share", "objects"}},
                 {"convergence", {"iterations", "inlier_rmse"}},
                 {"timing", {"milliseconds"}}};

PathMap path_map(const RunFiles& run, const RunContext& context) {
  PathMap map;
  for (const formats::StampedPose& pose : run.trajectory) {
    map.estimate.push_back(pose.T_world_sensor.translation());
  }
  if (context.truth) {
    for (const std::optional<Eigen::Isometry3d>& pose : context.truth->poses) {
      if (pose) {
        map.ground_truth.push_back(pose->translation());
      }
    }
  }
  return map;
}

}  // namespace

std::vector<Figure> draw_figures(const RunFiles& run, const RunContext& context, const drawing::Theme& theme) {
  std::vector<double> times;
  for (std::size_t k = 0; k < run.frames.size(); ++k) {
    times.push_back(run.seconds(k));
  }
  std::vector<Figure> figures;
  if (context.scan) {
    figures.push_back({"scan", scan_plot(*context.scan, theme)});
  }
  figures.push_back({"trajectory", trajectory_plot(path_map(run, context), theme)});
  const std::vector<RunSeries> all = run_series(run, context.truth);
  for (const auto& [name, ids] : kOverTime) {
    std::vector<Panel> panels;
    for (const RunSeries& series : all) {
      if (std::find(std::begin(ids), std::end(ids), series.id) != std::end(ids)) {
        panels.push_back(series.panel);
      }
    }
    if (!panels.empty()) {
      figures.push_back({name, series_plot(times, panels, theme)});
    }
  }
  return figures;
}

}  // namespace dynamic_icp::figures
