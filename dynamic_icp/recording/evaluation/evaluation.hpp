// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "dynamic_icp/recording/evaluation/absolute_error.hpp"
#include "dynamic_icp/recording/evaluation/association.hpp"
#include "dynamic_icp/recording/evaluation/consistency.hpp"
#include "dynamic_icp/recording/evaluation/relative_error.hpp"
#include "dynamic_icp/recording/evaluation/segment_error.hpp"
#include "dynamic_icp/recording/formats/trajectory.hpp"

namespace dynamic_icp::evaluation {

struct EvaluationConfig {
  AssociationConfig association;
  RelativeGap gap;
  Alignment alignment = Alignment::kSe3;
};

/// Throws UsageError naming the setting and its valid range.
void check_config(const EvaluationConfig& config);

/// Everything that is known about an estimate against a reference.
struct Evaluation {
  EvaluationConfig config;
  Association matched;
  RelativeError relative;
  SegmentError segments;
  AbsoluteError absolute;
  Consistency consistency;                        ///< of the stated covariances; no motions where none are stated
  double time_span_s = 0.0;                       ///< from the first to the last matched pose
  std::optional<double> reference_path_length_m;  ///< along the matched poses; empty when not finite
  std::optional<double> estimate_path_length_m;
  /// Steps from one matched pose to the next where the reference is static although the estimate moves at more than
  /// 0.5 m/s: the mark of a reference sampled at the nearest time, against which frame-to-frame errors mean little.
  std::size_t repeated_reference_poses = 0;
};

/// Compares an estimate with a reference. `stated` is empty or holds what is stated for each pose of the estimate.
/// Throws as `associate`, `consistency` and `check_config`.
Evaluation evaluate(const formats::Trajectory& estimate, const formats::Trajectory& reference,
                    const EvaluationConfig& config = {}, std::span<const StatedMotion> stated = {});

}  // namespace dynamic_icp::evaluation
