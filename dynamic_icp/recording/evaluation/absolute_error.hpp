// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/recording/evaluation/association.hpp"
#include "dynamic_icp/recording/evaluation/statistics.hpp"

namespace dynamic_icp::evaluation {

/// What the estimate is allowed to be moved by before positions are compared.
enum class Alignment {
  kNone,   ///< nothing: both trajectories are in the same world frame
  kFirst,  ///< the rigid motion that makes the first matched poses equal
  kSe3,    ///< the rigid motion with the least sum of squared distances
  kSim3,   ///< the same with a change of scale
};

/// How well the positions determined the alignment.
enum class AlignmentStatus {
  kNotRun,
  kGiven,   ///< kNone and kFirst: nothing was to be determined
  kUnique,  ///< one best alignment
  kLine,    ///< a rotation about a line is free (all positions on one line, or two poses)
  kPoint,   ///< any rotation will do (all positions equal, or unrelated); the scale stays 1
};

struct AbsoluteError {
  Alignment alignment = Alignment::kNone;
  AlignmentStatus status = AlignmentStatus::kNotRun;
  double scale = 1.0;
  /// The aligned position of an estimated one is scale * R * p + t, with R and t of this motion.
  Eigen::Isometry3d T_reference_estimate = Eigen::Isometry3d::Identity();
  std::vector<double> errors_m;             ///< one for each matched pose, after the alignment
  std::optional<Statistics> translation_m;  ///< ATE; empty where the alignment leaves nothing to measure
};

/// The absolute trajectory error: distances between matched positions after the alignment, which is found in closed
/// form (Horn 1987). Where the best alignment is not unique, the RMSE is that of all the best ones, and the rotation
/// that is free comes from the orientations of the first matched poses, so that the answer is always the same one.
/// A single pose has no error left after an alignment: there is no statistic then.
AbsoluteError absolute_error(const Association& matched, Alignment alignment = Alignment::kSe3);

}  // namespace dynamic_icp::evaluation
