// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/estimation/normal_equations.hpp"
#include "dynamic_icp/method/registration/linearisation.hpp"

namespace dynamic_icp::registration {

enum class AlignStatus {
  kNotRun,
  kConverged,
  kIterationLimit,
  kTooFewCorrespondences,
  kDegenerate,  ///< some directions are not constrained at all: see Alignment::degenerate
  kDiverged,    ///< a step was not finite or left the reach of any scan; the pose is the one before it
};
constexpr AlignStatus last_of(AlignStatus /*any*/) { return AlignStatus::kDiverged; }

std::string_view to_string(AlignStatus status);

/// The result of an alignment.
struct Alignment {
  AlignStatus status = AlignStatus::kNotRun;
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  int iterations = 0;
  double fitness = 0.0;      ///< share of the source points with a correspondence
  double inlier_rmse = 0.0;  ///< m, of the distances of the correspondences
  std::size_t correspondences = 0;
  TermStatistics geometry;         ///< m
  TermStatistics doppler;          ///< m/s; count 0 when the term is off
  double length_m = 1.0;           ///< makes rotations and translations comparable: typical distance of the points
  double information_ratio = 0.0;  ///< least over best constrained direction, of the scaled normal equations
  std::vector<estimation::DegenerateDirection> degenerate;  ///< empty unless the status says so
  /// Of the left perturbation [omega (rad); rho (m)] in the target frame; absent when it cannot be stated. It is
  /// H^-1 (sum w^2 r^2 J J^T) H^-1 over the residuals of this pair, so it needs no noise model, but it takes the
  /// residuals as independent and the correspondences as right: it is a lower bound.
  std::optional<Matrix6d> covariance;
};

}  // namespace dynamic_icp::registration
