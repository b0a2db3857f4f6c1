// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/recording/evaluation/association.hpp"

namespace dynamic_icp::evaluation {

/// What a method states about the motion from the frame before into this one, beside the pose.
struct StatedMotion {
  /// Of the left perturbation [omega (rad); rho (m)] of T_target_source, in the axes of this frame; empty where the
  /// method states none.
  std::optional<Matrix6d> covariance;
  bool ok = false;       ///< the method takes the pose for right: status "ok"
  bool skipped = false;  ///< a frame without a part in the motion: what the next one states does not begin here
};

/// The error of the motion into one frame against its covariance; the NEES as below.
struct MotionConsistency {
  std::size_t frame = 0;                   ///< of the whole estimate
  std::optional<double> nees_rotation;     ///< empty where the block of the covariance is not positive definite
  std::optional<double> nees_translation;  ///< the same
  bool within_4_sigma = false;             ///< |e_i| <= 4 sqrt(C_ii) on all six axes
};

/// Whether errors are as large as the covariances say. With the true and the estimated motion T_target_source between
/// two frames,
///
///   e = log(T_true T_estimate^-1),   NEES_b = e_b^T C_bb^-1 e_b,
///
/// where b is the rotation or the translation, three numbers each, and C_bb its block of the covariance. Right
/// covariances give a mean NEES of 3; more is overconfident, less too careful.
struct Consistency {
  std::size_t motions = 0;                 ///< with a covariance and a reference at both ends
  std::optional<double> nees_rotation;     ///< mean over the motions; empty without any
  std::optional<double> nees_translation;  ///< the same
  /// Share of the motions with status ok in which |e_i| > 4 sqrt(C_ii) on at least one of the six axes: 0.04 % of
  /// normal errors. Empty where there is none.
  std::optional<double> beyond_4_sigma;
};

/// e^T C^-1 e of an error and its covariance; empty where C is not positive definite or a number is not finite.
std::optional<double> squared_mahalanobis(const Eigen::Vector3d& e, const Eigen::Matrix3d& C);

/// Of all motions between frames that follow each other with a covariance and a reference at both ends. Throws
/// std::invalid_argument when `stated` is not as long as the whole estimate.
std::vector<MotionConsistency> motion_consistency(const Association& matched, std::span<const StatedMotion> stated);

/// The consistency of what is stated for each frame of the whole estimate. Only motions between frames that follow each
/// other count. A block that is not positive definite has no NEES, but counts among those beyond four sigma. Throws
/// std::invalid_argument when `stated` is not as long as the whole estimate.
Consistency consistency(const Association& matched, std::span<const StatedMotion> stated);

}  // namespace dynamic_icp::evaluation
