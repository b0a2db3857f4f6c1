// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::estimation {

/// The normal equations H xi = -b of weighted linear least squares with six unknowns, xi = [omega; rho] as in
/// base/se3.hpp: H = sum w J^T J, b = sum w J^T e.
struct NormalEquations {
  Matrix6d H = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();

  /// Adds one residual e with Jacobian J (d e / d xi) and weight w.
  void add(const Vector6d& J, double e, double w);

  /// Adds residuals that belong together: e^T W e with a symmetric weight matrix W.
  void add(const Eigen::Matrix<double, 3, 6>& J, const Eigen::Vector3d& e, const Eigen::Matrix3d& W);

  NormalEquations& operator+=(const NormalEquations& other);
};

/// Eigenvalues of a symmetric matrix, ascending, and its eigenvectors as columns.
struct SymmetricEigen {
  Vector6d values;
  Matrix6d vectors;
};

SymmetricEigen symmetric_eigen(const Matrix6d& matrix);

/// One direction of motion that the measurements do not constrain.
struct DegenerateDirection {
  Vector6d direction = Vector6d::Zero();  ///< unit vector [omega * length_m; rho], all in metres
  double information = 0.0;               ///< its eigenvalue over the largest one: 0 is not constrained at all
};

/// What the normal equations can tell, and what not.
struct Solution {
  Vector6d xi = Vector6d::Zero();               ///< the step; zero along degenerate directions
  std::vector<DegenerateDirection> degenerate;  ///< empty when all six directions are constrained
  double information_ratio = 0.0;               ///< smallest over largest eigenvalue of the scaled H
  std::optional<Matrix6d> inverse;              ///< of H; absent when degenerate
};

/// Solves H xi = -b. Rotation and translation have different units, so their sensitivities are compared after scaling
/// rotations by `length_m`, the typical distance of the points: a rotation of 1/length_m rad then moves them by about
/// one metre. A direction whose eigenvalue is below `rank_tolerance` times the largest is degenerate.
Solution solve(const NormalEquations& equations, double length_m, double rank_tolerance);

}  // namespace dynamic_icp::estimation
