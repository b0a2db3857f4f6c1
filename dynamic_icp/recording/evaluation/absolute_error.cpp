// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/absolute_error.hpp"

#include <cmath>

#include <Eigen/SVD>

namespace dynamic_icp::evaluation {
namespace {

// Positions closer together than this are one point: far below what any trajectory file resolves.
constexpr double kPointSpreadM = 1e-9;
// Relative size of a singular value that is rounding only.
constexpr double kSingular = 1e-12;

using Positions = Eigen::Matrix3Xd;

Positions positions_of(const formats::Trajectory& trajectory) {
  Positions positions(3, static_cast<Eigen::Index>(trajectory.size()));
  for (std::size_t k = 0; k < trajectory.size(); ++k) {
    positions.col(static_cast<Eigen::Index>(k)) = trajectory[k].T_world_sensor.translation();
  }
  return positions;
}

/// Rotation and scale of the best alignment of centred positions x (estimate) with y (reference), into `result`.
/// `R_first` takes the first estimated orientation to the first reference orientation.
void fit_rotation(const Positions& x, const Positions& y, const Eigen::Matrix3d& R_first, AbsoluteError& result) {
  const auto n = static_cast<double>(x.cols());
  const double spread_x = std::sqrt(x.squaredNorm() / n);
  const double spread_y = std::sqrt(y.squaredNorm() / n);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(y * x.transpose() / n, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d d = svd.singularValues();
  const Eigen::Matrix3d& U = svd.matrixU();
  const Eigen::Matrix3d& V = svd.matrixV();
  const double sign = U.determinant() * V.determinant() < 0.0 ? -1.0 : 1.0;

  if (spread_x <= kPointSpreadM || spread_y <= kPointSpreadM || d[0] <= kSingular * spread_x * spread_y) {
    result.status = AlignmentStatus::kPoint;
    result.T_reference_estimate.linear() = R_first;
    return;
  }
  // A turn in the plane of two axes changes the sum of squares by their singular values' (signed) sum: where the
  // smallest such sum vanishes, the turn is free.
  if (d[1] + sign * d[2] <= kSingular * d[0]) {
    result.status = AlignmentStatus::kLine;
    const Eigen::Vector3d line = R_first * V.col(0);
    result.T_reference_estimate.linear() =
        Eigen::Quaterniond::FromTwoVectors(line, U.col(0)).toRotationMatrix() * R_first;
  } else {
    result.status = AlignmentStatus::kUnique;
    result.T_reference_estimate.linear() = U * Eigen::Vector3d(1.0, 1.0, sign).asDiagonal() * V.transpose();
  }
  if (result.alignment == Alignment::kSim3) {
    result.scale = (d[0] + d[1] + sign * d[2]) / (spread_x * spread_x);
  }
}

/// The closed form of Umeyama: least squares over rotation, translation and (kSim3) scale.
void fit_positions(const Positions& x, const Positions& y, const Eigen::Matrix3d& R_first, AbsoluteError& result) {
  const Eigen::Vector3d mean_x = x.rowwise().mean();
  const Eigen::Vector3d mean_y = y.rowwise().mean();
  fit_rotation(x.colwise() - mean_x, y.colwise() - mean_y, R_first, result);
  result.T_reference_estimate.translation() = mean_y - result.scale * result.T_reference_estimate.linear() * mean_x;
}

}  // namespace

AbsoluteError absolute_error(const Association& matched, Alignment alignment) {
  AbsoluteError result;
  result.alignment = alignment;
  const Positions x = positions_of(matched.estimate);
  const Positions y = positions_of(matched.reference);
  // Squares must stay finite: a trajectory that went astray to 1e200 m has no error that could be told.
  if (matched.size() == 0 || !std::isfinite(x.squaredNorm()) || !std::isfinite(y.squaredNorm())) {
    return result;
  }
  const Eigen::Isometry3d T_first =
      matched.reference.front().T_world_sensor * matched.estimate.front().T_world_sensor.inverse();
  if (alignment == Alignment::kSe3 || alignment == Alignment::kSim3) {
    fit_positions(x, y, T_first.linear(), result);
  } else {
    result.status = AlignmentStatus::kGiven;
    result.T_reference_estimate = alignment == Alignment::kFirst ? T_first : Eigen::Isometry3d::Identity();
  }
  const Eigen::Matrix3d sR = result.scale * result.T_reference_estimate.linear();
  for (Eigen::Index k = 0; k < x.cols(); ++k) {
    result.errors_m.push_back((y.col(k) - sR * x.col(k) - result.T_reference_estimate.translation()).norm());
  }
  if (alignment == Alignment::kNone || matched.size() > 1) {
    result.translation_m = summarize(result.errors_m);
  }
  return result;
}

}  // namespace dynamic_icp::evaluation
