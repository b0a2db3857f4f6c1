// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/recording/evaluation/association.hpp"
#include "dynamic_icp/recording/evaluation/statistics.hpp"

namespace dynamic_icp::evaluation {

// The relative pose error: how far the estimated motion between two times is from the true one. With reference poses A
// and estimated poses B,
//
//   E = (A_i^-1 A_j)^-1 (B_i^-1 B_j);
//
// the translation error (RTE) is the length of its translation, the rotation error (RRE) the angle of its rotation. It
// does not depend on the choice of the world frame of either trajectory.

/// T_i^-1 T_j. The positions are subtracted before anything is turned, so that world coordinates of millions of metres
/// cost no digits.
Eigen::Isometry3d relative_motion(const Eigen::Isometry3d& T_i, const Eigen::Isometry3d& T_j);

struct MotionError {
  double translation_m = 0.0;
  double rotation_deg = 0.0;  ///< in [0, 180]
};

/// The error of the estimated motion from matched pose `from` to matched pose `to`.
MotionError motion_error(const Association& matched, std::size_t from, std::size_t to);

enum class GapUnit { kFrames, kSeconds, kMeters };

/// How far apart the two poses of a step are.
struct RelativeGap {
  GapUnit unit = GapUnit::kFrames;
  double length = 1.0;  ///< matched poses (a whole number), seconds, or metres along the reference
};

/// Throws UsageError when the length is not positive, beyond 1e9, or (kFrames) not a whole number.
void check_gap(const RelativeGap& gap);

/// One step of the comparison; `from` and `to` index the matched poses.
struct RelativeStep {
  std::size_t from = 0;
  std::size_t to = 0;
  MotionError error;
};

struct RelativeError {
  RelativeGap gap;
  std::vector<RelativeStep> steps;          ///< by increasing `from`, which occurs at most once
  std::size_t steps_over_unmatched = 0;     ///< steps between which lies an estimated pose without reference
  std::optional<Statistics> translation_m;  ///< RTE; empty without steps
  std::optional<Statistics> rotation_deg;   ///< RRE; empty without steps
};

/// The relative error over all steps of the wanted length.
///   - kFrames: from each matched pose to the one `length` matched poses later; 1 is frame to frame.
///   - kSeconds, kMeters: from each matched pose to the later one whose time, or distance along the reference, comes
///     nearest to `length` from there (the earlier of two equally near). There is no step where that is more than 10 %
///     off, because the poses are too sparse, nor where the trajectory ends before.
/// Throws as `check_gap`.
RelativeError relative_error(const Association& matched, const RelativeGap& gap = {});

}  // namespace dynamic_icp::evaluation
