// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/absolute_error.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

namespace dynamic_icp::evaluation {
namespace {

// Positions closer together than this are one point: far below what any trajectory file resolves.
constexpr double kPointSpreadM = 1e-9;
// Relative size of an eigenvalue that is rounding only.
constexpr double kSingular = 1e-12;

using Positions = Eigen::Matrix3Xd;

Positions positions_of(const formats::Trajectory& trajectory) {
  Positions positions(3, static_cast<Eigen::Index>(trajectory.size()));
  for (std::size_t k = 0; k < trajectory.size(); ++k) {
    positions.col(static_cast<Eigen::Index>(k)) = trajectory[k].T_world_sensor.translation();
  }
  return positions;
}

/// The symmetric matrix N of Horn: a unit quaternion q of a rotation R has q^T N q = sum y^T R x / n.
Eigen::Matrix4d horn_matrix(const Positions& x, const Positions& y) {
  const Eigen::Matrix3d S = x * y.transpose() / static_cast<double>(x.cols());
  const Eigen::Vector3d z(S(1, 2) - S(2, 1), S(2, 0) - S(0, 2), S(0, 1) - S(1, 0));
  Eigen::Matrix4d N;
  N << S.trace(), z.transpose(), z, S + S.transpose() - S.trace() * Eigen::Matrix3d::Identity();
  return N;
}

/// Rotation and scale of the best alignment of centred positions x (estimate) with y (reference), into `result`.
/// `R_first` takes the first estimated orientation to the first reference orientation; where several rotations are
/// best, the one next to it is taken.
void fit_rotation(const Positions& x, const Positions& y, const Eigen::Matrix3d& R_first, AbsoluteError& result) {
  const auto n = static_cast<double>(x.cols());
  const double spread_x = std::sqrt(x.squaredNorm() / n);
  const double spread_y = std::sqrt(y.squaredNorm() / n);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(horn_matrix(x, y));
  const Eigen::Vector4d& values = eigen.eigenvalues();
  if (spread_x <= kPointSpreadM || spread_y <= kPointSpreadM || values[3] <= kSingular * spread_x * spread_y) {
    result.status = AlignmentStatus::kPoint;
    result.T_reference_estimate.linear() = R_first;
    return;
  }
  Eigen::Vector4d q = eigen.eigenvectors().col(3);
  result.status = AlignmentStatus::kUnique;
  if (values[3] - values[2] <= kSingular * (values[3] + values[2])) {
    // A turn about a line is free: of the quaternions that are best, the one next to that of R_first.
    result.status = AlignmentStatus::kLine;
    const Eigen::Quaterniond first(R_first);
    const auto best = eigen.eigenvectors().rightCols<2>();
    const Eigen::Vector4d next =
        best * (best.transpose() * Eigen::Vector4d(first.w(), first.x(), first.y(), first.z()));
    q = next.norm() > kSingular ? next.normalized() : q;
  }
  result.T_reference_estimate.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  if (result.alignment == Alignment::kSim3) {
    result.scale = values[3] / (spread_x * spread_x);
  }
}

/// Closed form (Horn): least squares over rotation, translation and (kSim3) scale.
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
