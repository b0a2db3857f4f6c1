// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/rest_factor.hpp"

namespace dynamic_icp::window {

void RestFactor::set_tail(const Eigen::MatrixXd& rows) {
  const Eigen::Index n = rows.rows();
  const Eigen::Index head = rows.cols() - n;
  tail_.compute(rows.rightCols(n));
  W_ = rows.leftCols(head);
  tail_.matrixL().solveInPlace(W_);
  share_ = Eigen::MatrixXd::Zero(head, head);
  if (n > 0) {
    share_.selfadjointView<Eigen::Lower>().rankUpdate(W_.transpose());
  }
}

void RestFactor::compute(const Eigen::MatrixXd& A) { head_.compute(A - share_); }

bool RestFactor::is_solvable() const {
  // What is not a number anywhere is not one in the diagonal either.
  return tail_.info() == Eigen::Success && head_.info() == Eigen::Success && tail_.matrixLLT().diagonal().allFinite() &&
         head_.matrixLLT().diagonal().allFinite();
}

Eigen::VectorXd RestFactor::solve(const Eigen::VectorXd& b) const {
  const Eigen::Index n = W_.rows();
  const Eigen::Index head = W_.cols();
  const Eigen::VectorXd w = tail_.matrixL().solve(b.tail(n));
  Eigen::VectorXd x(b.size());
  x.head(head) = head_.solve(b.head(head) - W_.transpose() * w);
  x.tail(n) = tail_.matrixU().solve(w - W_ * x.head(head));
  return x;
}

Eigen::MatrixXd RestFactor::covariance_root(Eigen::MatrixXd sums) const {
  auto head = sums.topRows(W_.cols());
  auto tail = sums.bottomRows(W_.rows());
  tail_.matrixL().solveInPlace(tail);
  head.noalias() -= W_.transpose() * tail;
  head_.matrixL().solveInPlace(head);
  return sums;
}

}  // namespace dynamic_icp::window
