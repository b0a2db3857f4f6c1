// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/run_figures.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string_view>

#include "dynamic_icp/recording/runs/calibration_file.hpp"
#include "dynamic_icp/tools/figures/field_parts_plot.hpp"
#include "dynamic_icp/tools/figures/field_plot.hpp"
#include "dynamic_icp/tools/figures/run_series.hpp"
#include "dynamic_icp/tools/figures/scan_plot.hpp"
#include "dynamic_icp/tools/figures/series_plot.hpp"
#include "dynamic_icp/tools/figures/trajectory_plot.hpp"

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
                 {"consistency", {"nees", "innovation"}},
                 {"timing", {"milliseconds"}}};

std::vector<Eigen::Vector3d> positions_of(const runs::RunFiles& run) {
  std::vector<Eigen::Vector3d> positions;
  for (const formats::StampedPose& pose : run.trajectory) {
    positions.push_back(pose.T_world_sensor.translation());
  }
  return positions;
}

std::vector<Eigen::Vector3d> positions_of(const RunTruth& truth) {
  std::vector<Eigen::Vector3d> positions;
  for (const std::optional<Eigen::Isometry3d>& pose : truth.poses) {
    if (pose) {
      positions.push_back(pose->translation());
    }
  }
  return positions;
}

PathMap path_map(const runs::RunFiles& run, const RunContext& context) {
  return {.estimates = {{"estimate", positions_of(run)}},
          .ground_truth = context.truth ? positions_of(*context.truth) : std::vector<Eigen::Vector3d>()};
}

/// When each scan that any of the runs has was taken, s after the first of them; by its number in the recording.
std::map<std::size_t, double> times_of(const std::vector<ComparedRun>& runs) {
  std::map<std::size_t, Stamp> stamps;
  for (const ComparedRun& run : runs) {
    for (std::size_t k = 0; k < run.files.frames.size(); ++k) {
      stamps.emplace(run.files.frames[k].index, run.files.trajectory[k].stamp);
    }
  }
  std::map<std::size_t, double> times;
  for (const auto& [index, stamp] : stamps) {
    times[index] = seconds_between(stamps.begin()->second, stamp);
  }
  return times;
}

/// The values of a run in their places among those of all runs.
std::vector<double> placed(const std::vector<double>& values, const runs::RunFiles& run,
                           const std::map<std::size_t, double>& times) {
  std::map<std::size_t, double> of_scan;
  for (std::size_t k = 0; k < values.size(); ++k) {
    of_scan[run.frames[k].index] = values[k];
  }
  std::vector<double> all;
  for (const auto& [index, time] : times) {
    const auto found = of_scan.find(index);
    all.push_back(found == of_scan.end() ? std::numeric_limits<double>::quiet_NaN() : found->second);
  }
  return all;
}

/// One line a run of the series called `id`: its first line that is no ground truth.
std::optional<Panel> compared_panel(const std::vector<ComparedRun>& runs, const std::string& id,
                                    const std::map<std::size_t, double>& times) {
  std::optional<Panel> panel;
  for (const ComparedRun& run : runs) {
    for (const RunSeries& series : run_series(run.files, run.truth)) {
      if (series.id != id) {
        continue;
      }
      if (!panel) {
        panel = series.panel;
        panel->series.clear();
      }
      const auto line = std::find_if(series.panel.series.begin(), series.panel.series.end(),
                                     [](const Series& candidate) { return !candidate.broad; });
      panel->series.push_back({run.name, placed(line->values, run.files, times)});
      panel->logarithmic = panel->logarithmic || series.panel.logarithmic;
    }
  }
  if (panel && lie_far_apart(panel->series)) {
    panel->logarithmic = true;
  }
  return panel;
}

MapSize map_size(Medium medium) {
  return medium == Medium::kPaper
             ? MapSize{.width = kColumnWidth, .largest_height = 1.1 * kColumnWidth, .with_title = false}
             : MapSize{};
}

PanelSize panel_size(Medium medium) {
  return medium == Medium::kPaper ? PanelSize{.width = kColumnWidth, .height = 120.0, .with_titles = false}
                                  : PanelSize{};
}

/// On paper px are parts of a mm.
std::vector<Figure> on(Medium medium, std::vector<Figure> figures) {
  if (medium == Medium::kPaper) {
    for (Figure& figure : figures) {
      figure.svg.set_px_per_mm(kPaperPxPerMm);
    }
  }
  return figures;
}

}  // namespace

std::vector<Figure> draw_comparison(const std::vector<ComparedRun>& runs, const drawing::Theme& theme, Medium medium) {
  PathMap map{.title = "Trajectories from above"};
  for (const ComparedRun& run : runs) {
    map.estimates.push_back({run.name, positions_of(run.files)});
    if (map.ground_truth.empty() && run.truth) {
      map.ground_truth = positions_of(*run.truth);
    }
  }
  std::vector<Figure> figures = {{"trajectory", trajectory_plot(map, theme, map_size(medium))}};
  const std::map<std::size_t, double> times = times_of(runs);
  std::vector<double> seconds;
  for (const auto& [index, time] : times) {
    seconds.push_back(time);
  }
  for (const auto& [name, ids] : {std::pair("errors", std::vector{"translation_error", "rotation_error"}),
                                  {"convergence", {"iterations"}},
                                  {"timing", {"milliseconds"}}}) {
    std::vector<Panel> panels;
    for (const char* id : ids) {
      if (std::optional<Panel> panel = compared_panel(runs, id, times)) {
        panels.push_back(std::move(*panel));
      }
    }
    if (!panels.empty()) {
      figures.push_back({name, series_plot(seconds, panels, theme, panel_size(medium))});
    }
  }
  return on(medium, std::move(figures));
}

std::vector<Figure> draw_figures(const runs::RunFiles& run, const RunContext& context, const drawing::Theme& theme,
                                 Medium medium) {
  std::vector<double> times;
  for (std::size_t k = 0; k < run.frames.size(); ++k) {
    times.push_back(run.seconds(k));
  }
  std::vector<Figure> figures;
  if (context.scan) {
    figures.push_back({"scan", scan_plot(*context.scan, theme, medium)});
  }
  figures.push_back({"trajectory", trajectory_plot(path_map(run, context), theme, map_size(medium))});
  const std::vector<RunSeries> all = run_series(run, context.truth);
  for (const auto& [name, ids] : kOverTime) {
    std::vector<Panel> panels;
    for (const RunSeries& series : all) {
      if (std::find(std::begin(ids), std::end(ids), series.id) != std::end(ids)) {
        panels.push_back(series.panel);
      }
    }
    if (!panels.empty()) {
      figures.push_back({name, series_plot(times, panels, theme, panel_size(medium))});
    }
  }
  if (const auto calibration = runs::read_calibration_of(run.folder)) {
    figures.push_back({"doppler_error", field_plot(*calibration, theme, medium)});
    figures.push_back({"doppler_error_parts", field_parts_plot(*calibration, theme, medium)});
  }
  return on(medium, std::move(figures));
}

}  // namespace dynamic_icp::figures
