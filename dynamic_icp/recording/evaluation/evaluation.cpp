// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/evaluation.hpp"

#include <cmath>

namespace dynamic_icp::evaluation {
namespace {

std::optional<double> path_length(const formats::Trajectory& trajectory) {
  const double length_m = path_distances(trajectory).back();
  return std::isfinite(length_m) ? std::optional(length_m) : std::nullopt;
}

std::size_t count_repeated_reference_poses(const Association& matched) {
  constexpr double kMovingMps = 0.5;
  std::size_t count = 0;
  for (std::size_t k = 1; k < matched.size(); ++k) {
    const auto moved = [k](const formats::Trajectory& trajectory) -> Eigen::Vector3d {
      return trajectory[k].T_world_sensor.translation() - trajectory[k - 1].T_world_sensor.translation();
    };
    const double dt = seconds_between(matched.estimate[k - 1].stamp, matched.estimate[k].stamp);
    if (moved(matched.reference).isZero(0.0) && moved(matched.estimate).norm() > kMovingMps * dt) {
      ++count;
    }
  }
  return count;
}

}  // namespace

void check_config(const EvaluationConfig& config) {
  AssociationConfig association = config.association;
  check_fields(fields(association));
  check_gap(config.gap);
}

Evaluation evaluate(const formats::Trajectory& estimate, const formats::Trajectory& reference,
                    const EvaluationConfig& config, std::span<const StatedMotion> stated) {
  check_config(config);
  Evaluation result;
  result.config = config;
  result.matched = associate(estimate, reference, config.association);
  result.relative = relative_error(result.matched, config.gap);
  result.segments = segment_error(result.matched);
  result.absolute = absolute_error(result.matched, config.alignment);
  if (!stated.empty()) {
    result.consistency = consistency(result.matched, stated);
  }
  result.time_span_s = seconds_between(result.matched.estimate.front().stamp, result.matched.estimate.back().stamp);
  result.reference_path_length_m = path_length(result.matched.reference);
  result.estimate_path_length_m = path_length(result.matched.estimate);
  result.repeated_reference_poses = count_repeated_reference_poses(result.matched);
  return result;
}

}  // namespace dynamic_icp::evaluation
