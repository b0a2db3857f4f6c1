// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/relative_error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::evaluation {
namespace {

constexpr double kGapTolerance = 0.1;
// Twelve twelfths of a second, each rounded to a nanosecond, must count as a second. A share of the gap, but at most so
// many seconds or metres.
constexpr double kRounding = 1e-6;
constexpr double kMaxGapLength = 1e9;

/// How far along each matched pose is, in the unit of the gap. Never decreases.
std::vector<double> progress_of(const Association& matched, GapUnit unit) {
  if (unit == GapUnit::kMeters) {
    return path_distances(matched.reference);
  }
  std::vector<double> progress;
  for (std::size_t k = 0; k < matched.size(); ++k) {
    progress.push_back(unit == GapUnit::kSeconds
                           ? seconds_between(matched.estimate.front().stamp, matched.estimate[k].stamp)
                           : static_cast<double>(k));
  }
  return progress;
}

/// The end of the step that starts at `from`; empty when no pose is near enough to the wanted length.
std::optional<std::size_t> step_end(const std::vector<double>& progress, std::size_t from, double length) {
  const double target = progress[from] + length;
  const auto miss = [&](auto position) { return std::abs(*position - target); };
  const auto later = progress.begin() + static_cast<std::ptrdiff_t>(from) + 1;
  const auto reached = std::lower_bound(later, progress.end(), target - std::min(kRounding, kRounding * length));
  if (reached == progress.end()) {
    return std::nullopt;
  }
  const auto nearest = reached != later && miss(reached - 1) <= miss(reached) ? reached - 1 : reached;
  if (!(miss(nearest) <= kGapTolerance * length)) {
    return std::nullopt;
  }
  return static_cast<std::size_t>(nearest - progress.begin());
}

}  // namespace

Eigen::Isometry3d relative_motion(const Eigen::Isometry3d& T_i, const Eigen::Isometry3d& T_j) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = T_i.linear().transpose() * T_j.linear();
  T.translation() = T_i.linear().transpose() * (T_j.translation() - T_i.translation());
  return T;
}

void check_gap(const RelativeGap& gap) {
  const bool in_range = gap.length > 0.0 && gap.length <= kMaxGapLength;
  const bool whole = gap.length == std::floor(gap.length);
  if (gap.unit == GapUnit::kFrames && !(in_range && whole)) {
    throw UsageError(
        fmt::format("the gap is {} frames, expected a whole number from 1 to {:g}", gap.length, kMaxGapLength));
  }
  if (!in_range) {
    throw UsageError(fmt::format("the gap is {} {}, expected more than 0 and at most {:g}", gap.length,
                                 gap.unit == GapUnit::kSeconds ? "seconds" : "metres", kMaxGapLength));
  }
}

MotionError motion_error(const Association& matched, std::size_t from, std::size_t to) {
  const Eigen::Isometry3d A =
      relative_motion(matched.reference[from].T_world_sensor, matched.reference[to].T_world_sensor);
  const Eigen::Isometry3d B =
      relative_motion(matched.estimate[from].T_world_sensor, matched.estimate[to].T_world_sensor);
  const Eigen::Isometry3d E = relative_motion(A, B);
  return {E.translation().norm(), rotation_angle(E.linear()) * 180.0 / std::numbers::pi};
}

RelativeError relative_error(const Association& matched, const RelativeGap& gap) {
  check_gap(gap);
  RelativeError result;
  result.gap = gap;
  const std::vector<double> progress = progress_of(matched, gap.unit);
  std::vector<double> translations_m;
  std::vector<double> rotations_deg;
  for (std::size_t from = 0; from < matched.size(); ++from) {
    const std::optional<std::size_t> to = step_end(progress, from, gap.length);
    if (!to) {
      continue;
    }
    result.steps.push_back({from, *to, motion_error(matched, from, *to)});
    translations_m.push_back(result.steps.back().error.translation_m);
    rotations_deg.push_back(result.steps.back().error.rotation_deg);
    const std::size_t estimate_frames = matched.estimate_indices[*to] - matched.estimate_indices[from];
    result.steps_over_unmatched += estimate_frames == *to - from ? 0 : 1;
  }
  result.translation_m = summarize(translations_m);
  result.rotation_deg = summarize(rotations_deg);
  return result;
}

}  // namespace dynamic_icp::evaluation
