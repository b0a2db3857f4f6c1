// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/estimation/normal_equations.hpp"

#include <algorithm>

#include <Eigen/Eigenvalues>

namespace dynamic_icp::estimation {

void NormalEquations::add(const Vector6d& J, double e, double w) {
  const Vector6d weighted = w * J;
  // Only the lower triangle is summed; it is mirrored when the equations are solved.
  for (int column = 0; column < 6; ++column) {
    for (int row = column; row < 6; ++row) {
      H(row, column) += weighted[row] * J[column];
    }
  }
  b += weighted * e;
}

void NormalEquations::add(const Eigen::Matrix<double, 3, 6>& J, const Eigen::Vector3d& e, const Eigen::Matrix3d& W) {
  const Eigen::Matrix<double, 6, 3> weighted = J.transpose() * W;
  H.triangularView<Eigen::Lower>() += weighted * J;
  b += weighted * e;
}

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
  H += other.H;
  b += other.b;
  return *this;
}

SymmetricEigen symmetric_eigen(const Matrix6d& matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(matrix);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

Solution solve(const NormalEquations& equations, double length_m, double rank_tolerance) {
  Vector6d scale = Vector6d::Ones();
  scale.head<3>().setConstant(1.0 / length_m);
  Matrix6d scaled = equations.H.selfadjointView<Eigen::Lower>();
  scaled = scale.asDiagonal() * scaled * scale.asDiagonal();

  const auto [values, vectors] = symmetric_eigen(scaled);
  const double largest = values[5];
  Solution solution;
  solution.information_ratio = largest > 0.0 ? std::max(0.0, values[0]) / largest : 0.0;

  const Vector6d projected = vectors.transpose() * (scale.asDiagonal() * equations.b);
  Vector6d step = Vector6d::Zero();
  for (int k = 0; k < 6; ++k) {
    if (!(values[k] > rank_tolerance * largest)) {
      const double information = largest > 0.0 ? std::max(0.0, values[k]) / largest : 0.0;
      solution.degenerate.push_back({vectors.col(k), information});
    } else {
      step[k] = -projected[k] / values[k];
    }
  }
  solution.xi = scale.asDiagonal() * (vectors * step);
  if (solution.degenerate.empty()) {
    const Matrix6d inverse = vectors * values.cwiseInverse().asDiagonal() * vectors.transpose();
    solution.inverse = scale.asDiagonal() * inverse * scale.asDiagonal();
  }
  return solution;
}

}  // namespace dynamic_icp::estimation
