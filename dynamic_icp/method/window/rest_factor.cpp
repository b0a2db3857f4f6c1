// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/rest_factor.hpp"

#include <algorithm>
#include <vector>

#include "dynamic_icp/method/base/replace.hpp"

namespace dynamic_icp::window {
namespace {

// Columns of the head that are treated alike.
constexpr Eigen::Index kColumns = 24;

/// Some columns of W, and the first row in which there is anything.
struct Columns {
  Eigen::Index begin = 0;
  Eigen::Index count = 0;
  Eigen::Index row = 0;
};

std::vector<Columns> columns_of(const Eigen::MatrixXd& W) {
  std::vector<Columns> result;
  for (Eigen::Index begin = 0; begin < W.cols(); begin += kColumns) {
    Columns columns{begin, std::min(kColumns, W.cols() - begin), 0};
    while (columns.row < W.rows() && W.row(columns.row).segment(begin, columns.count).isZero(0.0)) {
      ++columns.row;
    }
    if (columns.row < W.rows()) {
      result.push_back(columns);
    }
  }
  return result;
}

}  // namespace

/// The prior joins near coefficients alone: W begins the lower the later they are.
void RestFactor::set_tail(const Eigen::MatrixXd& rows) {
  const Eigen::Index n = rows.rows();
  const Eigen::Index head = rows.cols() - n;
  replace(tail_, rows.rightCols(n));
  replace(W_, rows.leftCols(head));
  replace(share_, Eigen::MatrixXd::Zero(head, head));
  const std::vector<Columns> parts = columns_of(W_);
  for (const Columns& a : parts) {
    const Eigen::Index left = n - a.row;
    tail_.matrixLLT()
        .bottomRightCorner(left, left)
        .triangularView<Eigen::Lower>()
        .solveInPlace(W_.block(a.row, a.begin, left, a.count));
  }
  for (const Columns& a : parts) {
    for (const Columns& b : parts) {
      if (b.begin <= a.begin) {
        const Eigen::Index left = n - std::max(a.row, b.row);
        share_.block(a.begin, b.begin, a.count, b.count).noalias() =
            W_.bottomRows(left).middleCols(a.begin, a.count).transpose() *
            W_.bottomRows(left).middleCols(b.begin, b.count);
      }
    }
  }
}

void RestFactor::compute(const Eigen::MatrixXd& A) { replace(head_, A - share_); }

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
  if (sums.cols() == 0) {
    return sums;  // no memory, in which no block begins
  }
  auto head = sums.topRows(W_.cols());
  auto tail = sums.bottomRows(W_.rows());
  tail_.matrixL().solveInPlace(tail);
  head.noalias() -= W_.transpose() * tail;
  head_.matrixL().solveInPlace(head);
  return sums;
}

}  // namespace dynamic_icp::window
