// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace dynamic_icp::window {

/// A Cholesky factor of the information of all unknowns but theta, [head; tail] (Layout): no measurement sees the tail,
/// so it is eliminated once for all steps of a scan, and each step factors the head alone,
///   S = [A X; X^T D],   D = L_D L_D^T,   W = L_D^-1 X^T,   A - W^T W = L_A L_A^T.
class RestFactor {
 public:
  /// The rows [X^T D]; of D the lower triangle. They hold until they are set again.
  void set_tail(const Eigen::MatrixXd& rows);

  /// With A, of which the lower triangle is read.
  void compute(const Eigen::MatrixXd& A);

  [[nodiscard]] bool is_solvable() const;
  [[nodiscard]] Eigen::Index size() const { return head_.rows() + W_.rows(); }

  /// L_A
  [[nodiscard]] const Eigen::LLT<Eigen::MatrixXd>& head() const { return head_; }

  /// S^-1 b
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

  /// Z with the covariance Z^T Z of the sums whose weights are the columns of `sums`.
  [[nodiscard]] Eigen::MatrixXd covariance_root(Eigen::MatrixXd sums) const;

 private:
  Eigen::LLT<Eigen::MatrixXd> tail_;
  Eigen::MatrixXd W_;      ///< tail x head
  Eigen::MatrixXd share_;  ///< W^T W; the lower triangle
  Eigen::LLT<Eigen::MatrixXd> head_;
};

}  // namespace dynamic_icp::window
