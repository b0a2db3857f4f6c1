// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "testing/dense_algebra.hpp"

#include <limits>

#include <Eigen/Dense>

namespace dynamic_icp::dense {

using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd least_squares(const MatrixXd& A, const VectorXd& b) { return A.colPivHouseholderQr().solve(b); }

VectorXd singular_values(const MatrixXd& A) { return Eigen::JacobiSVD<MatrixXd>(A).singularValues(); }

MatrixXd left_singular_vectors(const MatrixXd& A) {
  return Eigen::JacobiSVD<MatrixXd>(A, Eigen::ComputeFullU).matrixU();
}

MatrixXd solve(const MatrixXd& A, const MatrixXd& B) { return A.partialPivLu().solve(B); }

MatrixXd inverse(const MatrixXd& A) { return solve(A, MatrixXd::Identity(A.rows(), A.cols())); }

MatrixXd cholesky_root(const MatrixXd& A) {
  const Eigen::LLT<MatrixXd> factor(A);
  if (factor.info() != Eigen::Success) {
    return MatrixXd::Constant(A.rows(), A.cols(), std::numeric_limits<double>::quiet_NaN());
  }
  return factor.matrixL();
}

SymmetricParts symmetric_parts(const MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::Isometry3d rigid_motion(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to) {
  return Eigen::Isometry3d(Eigen::umeyama(from, to, false));
}

MatrixXd random_matrix(std::mt19937& random, Eigen::Index rows, Eigen::Index columns) {
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

MatrixXd random_information(std::mt19937& random, Eigen::Index n) {
  const MatrixXd A = random_matrix(random, n, n);
  return A * A.transpose() + MatrixXd::Identity(n, n);
}

double normalised_squared(const VectorXd& e, const MatrixXd& covariance) {
  return e.dot(VectorXd(solve(covariance, e)));
}

}  // namespace dynamic_icp::dense
