// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/consistency.hpp"

#include <cmath>
#include <stdexcept>

#include <Eigen/Cholesky>

#include "dynamic_icp/recording/evaluation/relative_error.hpp"

namespace dynamic_icp::evaluation {
namespace {

constexpr double kSigmas = 4.0;

/// e = log(T_true T_estimate^-1) of the motion into the matched pose `to` from the one before.
Vector6d perturbation(const Association& matched, std::size_t to) {
  const Eigen::Isometry3d T_true =
      relative_motion(matched.reference[to].T_world_sensor, matched.reference[to - 1].T_world_sensor);
  const Eigen::Isometry3d T_estimate_inverse =
      relative_motion(matched.estimate[to - 1].T_world_sensor, matched.estimate[to].T_world_sensor);
  return log_se3(T_true * T_estimate_inverse);
}

struct Mean {
  double sum = 0.0;
  std::size_t count = 0;

  void add(const std::optional<double>& value) {
    sum += value.value_or(0.0);
    count += value ? 1 : 0;
  }
  [[nodiscard]] std::optional<double> value() const {
    const double mean = sum / static_cast<double>(count);
    return count > 0 && std::isfinite(mean) ? std::optional(mean) : std::nullopt;
  }
};

bool is_within_sigmas(const Vector6d& e, const Matrix6d& C) {
  return (e.array().square() <= kSigmas * kSigmas * C.diagonal().array()).all();  // false also for NaN
}

}  // namespace

std::optional<double> squared_mahalanobis(const Eigen::Vector3d& e, const Eigen::Matrix3d& C) {
  const Eigen::LLT<Eigen::Matrix3d> cholesky(C);
  if (!C.allFinite() || cholesky.info() != Eigen::Success) {
    return std::nullopt;
  }
  const double value = e.dot(cholesky.solve(e));
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::vector<MotionConsistency> motion_consistency(const Association& matched, std::span<const StatedMotion> stated) {
  if (stated.size() != matched.estimate_count) {
    throw std::invalid_argument("consistency: expected a statement for each pose of the estimate");
  }
  std::vector<MotionConsistency> motions;
  for (std::size_t k = 1; k < matched.size(); ++k) {
    const std::size_t frame = matched.estimate_indices[k];
    const StatedMotion& motion = stated[frame];
    if (!motion.covariance || matched.estimate_indices[k - 1] + 1 != frame || stated[frame - 1].skipped) {
      continue;
    }
    const Vector6d e = perturbation(matched, k);
    motions.push_back(
        {.frame = frame,
         .nees_rotation = squared_mahalanobis(e.head<3>(), motion.covariance->topLeftCorner<3, 3>()),
         .nees_translation = squared_mahalanobis(e.tail<3>(), motion.covariance->bottomRightCorner<3, 3>()),
         .within_4_sigma = is_within_sigmas(e, *motion.covariance)});
  }
  return motions;
}

Consistency consistency(const Association& matched, std::span<const StatedMotion> stated) {
  Consistency result;
  Mean rotation;
  Mean translation;
  Mean beyond;
  for (const MotionConsistency& motion : motion_consistency(matched, stated)) {
    ++result.motions;
    rotation.add(motion.nees_rotation);
    translation.add(motion.nees_translation);
    if (stated[motion.frame].ok) {
      beyond.add(motion.within_4_sigma ? 0.0 : 1.0);
    }
  }
  result.nees_rotation = rotation.value();
  result.nees_translation = translation.value();
  result.beyond_4_sigma = beyond.value();
  return result;
}

}  // namespace dynamic_icp::evaluation
