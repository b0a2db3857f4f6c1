// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/run_series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/recording/evaluation/consistency.hpp"

namespace dynamic_icp::figures {
namespace {

/// One value of each frame.
template <class Value>
std::vector<double> per_frame(const runs::RunFiles& run, const Value& value) {
  std::vector<double> values;
  values.reserve(run.frames.size());
  for (const runs::FrameRow& frame : run.frames) {
    values.push_back(value(frame));
  }
  return values;
}

/// How a series is called and measured.
struct Heading {
  const char* id;
  const char* title;
  const char* quantity;  ///< at the axis
  const char* unit;
};

RunSeries make_series(const Heading& heading, std::vector<Series> series) {
  return {.id = heading.id,
          .unit = heading.unit,
          .panel = {.title = heading.title,
                    .label = *heading.unit == '\0' ? heading.quantity
                                                   : fmt::format("{} ({})", heading.quantity, heading.unit),
                    .series = std::move(series)}};
}

constexpr double kMillimetres = 1000.0;

std::vector<double> scaled(std::vector<double> values, double factor) {
  std::for_each(values.begin(), values.end(), [&](double& value) { value *= factor; });
  return values;
}

RunSeries error_series(const Heading& heading, const std::vector<double>& errors) {
  RunSeries series = make_series(heading, {{"scan to scan", errors}});
  series.panel.logarithmic = spans_decades(errors);
  return series;
}

/// A value of the registration; a gap where nothing was registered: at the first scan, and at those that are lost
/// without a single step.
std::vector<Series> registration(const runs::RunFiles& run, double runs::FrameRow::*value) {
  return {{"per scan", per_frame(run, [&](const runs::FrameRow& frame) {
             const bool registered = frame.reason != "first" && (frame.status != "lost" || frame.iterations > 0.0);
             return registered ? frame.*value : std::numeric_limits<double>::quiet_NaN();
           })}};
}

/// Percent of the points used; a gap where none was used.
Series share(const runs::RunFiles& run, const char* name, double runs::FrameRow::*count) {
  return {name, per_frame(run, [&](const runs::FrameRow& frame) { return 100.0 * frame.*count / frame.points_used; })};
}

RunSeries ego_speed(const runs::RunFiles& run, const std::optional<RunTruth>& truth) {
  std::vector<Series> series;
  if (truth) {
    series.push_back({"ground truth", truth->speed, true});
  }
  series.push_back(
      {"estimate", per_frame(run, [](const runs::FrameRow& f) { return runs::velocity_at_stamp(f).norm(); })});
  return make_series({"ego_speed", "Ego speed", "speed", "m/s"}, std::move(series));
}

RunSeries objects(const runs::RunFiles& run) {
  Series count{"objects with a velocity", {}};
  for (const std::vector<runs::ObjectRow>& list : run.objects) {
    count.values.push_back(static_cast<double>(list.size()));
  }
  RunSeries series = make_series({"objects", "Moving objects", "number", ""}, {count});
  series.panel.whole_numbers = true;
  return series;
}

/// How far the run is from the ground truth, which begins at its first matched pose.
RunSeries position_error(const runs::RunFiles& run, const RunTruth& truth) {
  std::vector<double> errors(run.frames.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < errors.size(); ++k) {
    if (truth.poses[k]) {
      errors[k] = (run.trajectory[k].T_world_sensor.translation() - truth.poses[k]->translation()).norm();
    }
  }
  return make_series({"position_error", "Position error, aligned at the start", "error", "m"}, {{"error", errors}});
}

/// Squared errors over their covariances, of three numbers each.
RunSeries squared_ratios(const char* id, const char* title, const char* quantity, std::vector<double> rotation,
                         std::vector<double> translation) {
  constexpr double kDegreesOfFreedom = 3.0;
  RunSeries series = make_series({id, title, quantity, ""},
                                 {{"translation", std::move(translation)}, {"rotation", std::move(rotation)}});
  series.panel.logarithmic = true;
  series.panel.levels = {{kDegreesOfFreedom, "expected mean"}};
  return series;
}

/// The motion into a frame against the one that the twist at the frame before predicts, as the squared difference over
/// what both state of themselves.
RunSeries innovations(const runs::RunFiles& run) {
  std::vector<double> rotation(run.frames.size(), std::numeric_limits<double>::quiet_NaN());
  std::vector<double> translation = rotation;
  for (std::size_t k = 1; k < run.frames.size(); ++k) {
    const std::optional<runs::TwistRow>& twist = run.frames[k - 1].twist;
    const std::optional<Matrix6d>& covariance = run.frames[k].pose_covariance;
    if (!twist || !twist->covariance || !covariance || run.frames[k].status == "lost") {
      continue;
    }
    const double dt_s = run.seconds(k) - run.seconds(k - 1);
    const Vector6d predicted = dt_s * (Vector6d() << twist->angular, twist->linear).finished();
    const Eigen::Isometry3d T_before_after =
        run.trajectory[k - 1].T_world_sensor.inverse() * run.trajectory[k].T_world_sensor;
    const Vector6d innovation = log_se3(exp_se3(predicted).inverse() * T_before_after);
    const Matrix6d S = dt_s * dt_s * *twist->covariance + *covariance;
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    rotation[k] = evaluation::squared_mahalanobis(innovation.head<3>(), S.topLeftCorner<3, 3>()).value_or(kNone);
    translation[k] = evaluation::squared_mahalanobis(innovation.tail<3>(), S.bottomRightCorner<3, 3>()).value_or(kNone);
  }
  return squared_ratios("innovation", "Normalised innovation squared (constant velocity)", "NIS", std::move(rotation),
                        std::move(translation));
}

double stage_time(const runs::FrameRow& frame, const std::string& stage) {
  const auto found = std::find_if(frame.milliseconds.begin(), frame.milliseconds.end(),
                                  [&](const auto& entry) { return entry.first == stage; });
  return found == frame.milliseconds.end() ? 0.0 : found->second;
}

/// The total first, then the stages as they stand in the first frame.
RunSeries milliseconds(const runs::RunFiles& run) {
  std::vector<std::string> stages = {"total"};
  if (!run.frames.empty()) {
    for (const auto& [stage, value] : run.frames.front().milliseconds) {
      if (stage != "total") {
        stages.push_back(stage);
      }
    }
  }
  std::vector<Series> series;
  for (const std::string& stage : stages) {
    series.push_back({stage, per_frame(run, [&](const runs::FrameRow& frame) { return stage_time(frame, stage); })});
  }
  return make_series({"milliseconds", "Computing time", "time per scan", "ms"}, std::move(series));
}

bool has_values(const RunSeries& series) {
  return std::any_of(series.panel.series.begin(), series.panel.series.end(), [](const Series& line) {
    return std::any_of(line.values.begin(), line.values.end(), [](double value) { return std::isfinite(value); });
  });
}

}  // namespace

std::vector<RunSeries> run_series(const runs::RunFiles& run, const std::optional<RunTruth>& truth) {
  std::vector<RunSeries> all = {ego_speed(run, truth)};
  if (truth) {
    all.push_back(error_series({"translation_error", "RTE per scan", "RTE", "mm"},
                               scaled(truth->translation_error, kMillimetres)));
    all.push_back(error_series({"rotation_error", "RRE per scan", "RRE", "degrees"}, truth->rotation_error));
    all.push_back(position_error(run, *truth));
    all.push_back(squared_ratios("nees", "Consistency: NEES", "NEES", truth->nees_rotation, truth->nees_translation));
  }
  all.push_back(innovations(run));
  all.push_back(
      make_series({"iterations", "Iterations", "number", ""}, registration(run, &runs::FrameRow::iterations)));
  all.back().panel.whole_numbers = true;
  std::vector<Series> inlier_rmse = registration(run, &runs::FrameRow::inlier_rmse);
  inlier_rmse.front().values = scaled(std::move(inlier_rmse.front().values), kMillimetres);
  all.push_back(make_series({"inlier_rmse", "Inlier RMSE", "inlier RMSE", "mm"}, std::move(inlier_rmse)));
  all.push_back(
      make_series({"fitness", "Fitness", "share of points matched", ""}, registration(run, &runs::FrameRow::fitness)));
  all.push_back(make_series({"degeneracy", "Degeneracy: information ratio (eigenvalues)", "information ratio", ""},
                            registration(run, &runs::FrameRow::information_ratio)));
  all.back().panel.logarithmic = true;
  all.push_back(make_series({"dynamic_share", "Moving points", "share of points used", "%"},
                            {share(run, "flagged", &runs::FrameRow::dynamic_candidates),
                             share(run, "in a cluster", &runs::FrameRow::dynamic_clustered),
                             share(run, "on an object", &runs::FrameRow::dynamic_refined)}));
  all.push_back(objects(run));
  all.push_back(milliseconds(run));
  std::erase_if(all, [](const RunSeries& series) { return !has_values(series); });
  return all;
}

}  // namespace dynamic_icp::figures
