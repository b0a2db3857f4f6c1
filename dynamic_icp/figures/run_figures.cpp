// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/figures/run_figures.hpp"

#include <algorithm>
#include <limits>

#include "dynamic_icp/figures/scan_plot.hpp"
#include "dynamic_icp/figures/series_plot.hpp"
#include "dynamic_icp/figures/trajectory_plot.hpp"

namespace dynamic_icp::figures {
namespace {

/// One value of each frame.
template <class Value>
std::vector<double> per_frame(const RunFiles& run, const Value& value) {
  std::vector<double> values;
  values.reserve(run.frames.size());
  for (const FrameRow& frame : run.frames) {
    values.push_back(value(frame));
  }
  return values;
}

/// Percent of the points used; a gap where none was used.
Series share(const RunFiles& run, const char* name, double FrameRow::*count) {
  return {name, per_frame(run, [&](const FrameRow& frame) { return 100.0 * frame.*count / frame.points_used; })};
}

PathMap path_map(const RunFiles& run, const RunContext& context) {
  PathMap map;
  for (const formats::StampedPose& pose : run.trajectory) {
    map.estimate.push_back(pose.T_world_sensor.translation());
  }
  if (context.truth) {
    map.ground_truth = context.truth->positions;
  }
  return map;
}

std::vector<Panel> error_panels(const RunTruth& truth) {
  return {{.title = "Translation error per scan",
           .label = "RTE (m)",
           .series = {{"from the scan before", truth.translation_error}},
           .logarithmic = spans_decades(truth.translation_error)},
          {.title = "Rotation error per scan",
           .label = "RRE (degrees)",
           .series = {{"from the scan before", truth.rotation_error}},
           .logarithmic = spans_decades(truth.rotation_error)}};
}

std::vector<Panel> speed_panels(const RunFiles& run, const RunContext& context) {
  Panel panel{.title = "Ego speed", .label = "speed (m/s)", .series = {}};
  if (context.truth) {
    panel.series.push_back({"ground truth", context.truth->speed, true});
  }
  panel.series.push_back(
      {"estimate from Doppler", per_frame(run, [](const FrameRow& frame) { return frame.ego_velocity.norm(); })});
  return {panel};
}

std::vector<Panel> dynamics_panels(const RunFiles& run) {
  Series objects{"objects with a velocity", {}};
  for (const std::vector<ObjectRow>& list : run.objects) {
    objects.values.push_back(static_cast<double>(list.size()));
  }
  return {{.title = "Moving points",
           .label = "share of points used (%)",
           .series = {share(run, "flagged", &FrameRow::dynamic_candidates),
                      share(run, "in a cluster", &FrameRow::dynamic_clustered),
                      share(run, "on an object", &FrameRow::dynamic_refined)}},
          {.title = "Moving objects", .label = "number", .series = {objects}, .whole_numbers = true}};
}

/// A value of the registration; a gap at the first scan, which has nothing to be registered to.
Series registration(const RunFiles& run, double FrameRow::*value) {
  return {"per scan", per_frame(run, [&](const FrameRow& frame) {
            return frame.status == "first" ? std::numeric_limits<double>::quiet_NaN() : frame.*value;
          })};
}

std::vector<Panel> convergence_panels(const RunFiles& run) {
  return {{.title = "Iterations",
           .label = "number",
           .series = {registration(run, &FrameRow::iterations)},
           .whole_numbers = true},
          {.title = "Distance of matched points",
           .label = "inlier RMSE (m)",
           .series = {registration(run, &FrameRow::inlier_rmse)}}};
}

double stage_time(const FrameRow& frame, const std::string& stage) {
  const auto found = std::find_if(frame.milliseconds.begin(), frame.milliseconds.end(),
                                  [&](const auto& entry) { return entry.first == stage; });
  return found == frame.milliseconds.end() ? 0.0 : found->second;
}

/// The total first, then the stages as they stand in the first frame.
std::vector<Panel> timing_panels(const RunFiles& run) {
  std::vector<std::string> stages = {"total"};
  if (!run.frames.empty()) {
    for (const auto& [stage, value] : run.frames.front().milliseconds) {
      if (stage != "total") {
        stages.push_back(stage);
      }
    }
  }
  Panel panel{.title = "Computing time", .label = "ms per scan", .series = {}};
  for (const std::string& stage : stages) {
    panel.series.push_back({stage, per_frame(run, [&](const FrameRow& frame) { return stage_time(frame, stage); })});
  }
  return {panel};
}

}  // namespace

std::vector<Figure> draw_figures(const RunFiles& run, const RunContext& context, const drawing::Theme& theme) {
  std::vector<double> times;
  for (std::size_t k = 0; k < run.frames.size(); ++k) {
    times.push_back(run.seconds(k));
  }
  std::vector<Figure> figures;
  const auto add_series = [&](const char* name, const std::vector<Panel>& panels) {
    figures.push_back({name, series_plot(times, panels, theme)});
  };
  if (context.scan) {
    figures.push_back({"scan", scan_plot(*context.scan, theme)});
  }
  figures.push_back({"trajectory", trajectory_plot(path_map(run, context), theme)});
  if (context.truth) {
    add_series("errors", error_panels(*context.truth));
  }
  add_series("speed", speed_panels(run, context));
  add_series("dynamics", dynamics_panels(run));
  add_series("convergence", convergence_panels(run));
  add_series("timing", timing_panels(run));
  return figures;
}

}  // namespace dynamic_icp::figures
