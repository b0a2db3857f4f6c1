// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/field_elimination.hpp"

namespace dynamic_icp::window {

FieldElimination::FieldElimination(const Eigen::MatrixXd& F, const Eigen::MatrixXd& H, bool is_learned)
    : factor_(F), is_learned_(is_learned) {
  const Eigen::Index n = H.rows() - F.rows();
  rest_ = H.bottomRightCorner(n, n);
  if (is_learned_) {
    W_ = H.bottomLeftCorner(n, F.rows()).transpose();
    factor_.matrixL().solveInPlace(W_);
    rest_.selfadjointView<Eigen::Lower>().rankUpdate(W_.transpose(), -1.0);
  }
}

Eigen::VectorXd FieldElimination::rest_gradient(const Eigen::VectorXd& gradient) const {
  Eigen::VectorXd result = gradient.tail(rest_.rows());
  if (is_learned_) {
    result.noalias() -= W_.transpose() * factor_.matrixL().solve(gradient.head(factor_.rows()));
  }
  return result;
}

Eigen::VectorXd FieldElimination::step(const Eigen::VectorXd& gradient, const Eigen::VectorXd& rest_step) const {
  if (!is_learned_) {
    return Eigen::VectorXd::Zero(factor_.rows());
  }
  const Eigen::VectorXd w = factor_.matrixL().solve(gradient.head(factor_.rows()));
  return -factor_.matrixU().solve(w + W_ * rest_step);
}

Eigen::MatrixXd FieldElimination::covariance_root(const Eigen::LLT<Eigen::MatrixXd>& rest) const {
  // P = F^-1 + L^-T W C W^T L^-1 with C = (A A^T)^-1, A the factor of the rest
  const Eigen::Index n = factor_.rows();
  Eigen::MatrixXd root = Eigen::MatrixXd::Zero(n, n + (is_learned_ ? rest.rows() : 0));
  root.leftCols(n).setIdentity();
  if (is_learned_) {
    root.rightCols(rest.rows()) = W_;
    rest.matrixU().solveInPlace<Eigen::OnTheRight>(root.rightCols(rest.rows()));
  }
  factor_.matrixU().solveInPlace(root);
  return root;
}

}  // namespace dynamic_icp::window
