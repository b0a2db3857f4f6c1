// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace dynamic_icp::window {

/// Theta, on which everything depends linearly, eliminated from the normal equations of z = [theta; rest],
///   H = [F X; X^T R],   F = L L^T,   W = L^-1 X.
/// The rest alone has the information R - W^T W, and the gradient g_rest - W^T L^-1 g_theta. Its Cholesky factor serves
/// for as long as theta's share of H stays.
class FieldElimination {
 public:
  FieldElimination() = default;

  /// F with the prior of theta; H of all unknowns, whose own block of theta is not read. Of both the lower triangle.
  /// Without `is_learned` theta stays where it is, and the rest does not depend on it.
  FieldElimination(const Eigen::MatrixXd& F, const Eigen::MatrixXd& H, bool is_learned);

  [[nodiscard]] bool is_solvable() const { return factor_.info() == Eigen::Success; }

  /// R - W^T W; the lower triangle.
  [[nodiscard]] const Eigen::MatrixXd& rest() const { return rest_; }

  /// From the gradient of all unknowns.
  [[nodiscard]] Eigen::VectorXd rest_gradient(const Eigen::VectorXd& gradient) const;

  /// The step of theta that goes with a step of the rest.
  [[nodiscard]] Eigen::VectorXd step(const Eigen::VectorXd& gradient, const Eigen::VectorXd& rest_step) const;

  /// M with M M^T the covariance of theta, from the factor of the information of the rest.
  [[nodiscard]] Eigen::MatrixXd covariance_root(const Eigen::LLT<Eigen::MatrixXd>& rest) const;

 private:
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::MatrixXd W_;
  Eigen::MatrixXd rest_;
  bool is_learned_ = true;
};

}  // namespace dynamic_icp::window
