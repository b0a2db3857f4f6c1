// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/window/doppler_terms.hpp"
#include "dynamic_icp/method/window/spline_trajectory.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::window {

/// 1/m^2 or 1/rad^2: keeps what nothing is known of solvable.
inline constexpr double kNothing = 1e-9;

/// All that past scans say of the unknowns z = [theta; map error; stamp errors; coefficients], as the quadratic
///   1/2 d^T Q d + g^T d,   d = z - z_0,
/// about the estimate z_0 at which they were linearised. What has no future is eliminated, what changes its meaning is
/// transformed; nothing is approximated but the linearisation.
class WindowQuadratic {
 public:
  WindowQuadratic(Eigen::Index field_size, std::size_t coefficients, bool vibrates);

  [[nodiscard]] const Layout& layout() const { return layout_; }
  [[nodiscard]] const Eigen::MatrixXd& Q() const { return Q_; }
  [[nodiscard]] const Eigen::VectorXd& g() const { return g_; }

  /// Adds what else is known of theta: of H the lower triangle.
  void add_field(const Eigen::MatrixXd& H, const Eigen::VectorXd& g);

  /// Replaces the quadratic, of which the lower triangle is given; the layout stays.
  void set(Eigen::MatrixXd Q, Eigen::VectorXd g);

  /// What is known of theta, where nothing else is.
  void set_field(const Eigen::MatrixXd& Q, const Eigen::VectorXd& g);

  /// Coefficients of which nothing is known are appended.
  void append_coefficients(std::size_t count);

  /// The error of the last stamp is eliminated, that of the stamp at hand becomes the last, a new one is unknown.
  void next_stamp();

  /// The first coefficients are eliminated.
  void drop_coefficients(std::size_t count);

  /// Everything but theta is eliminated, and `coefficients` unknown ones follow.
  void keep_field_only(std::size_t coefficients);

  /// The reference pose moved: coefficients changed by d c_before = A d c_after, see SplineTrajectory::move_reference;
  /// the map error at each node is a rigid displacement about the reference and changes by `map_change`.
  void move_reference(const std::vector<Matrix6d>& changes, const Matrix6d& map_change);

  /// The map takes in a scan: map error' = (1 - share) map error + share J dc, with the error of the sweep J dc.
  void mix_map_error(double share, const Eigen::MatrixXd& J);

  /// Some unknowns, from `begin` on, walk at random with the covariance W: Q <- (Q^-1 + W)^-1, the estimate stays.
  void walk(Eigen::Index begin, const Eigen::MatrixXd& W);

  void state(StateArchive& archive);

 private:
  void mirror(Eigen::Index size);
  void subtract(const Eigen::MatrixXd& W, const Eigen::VectorXd& w);

  Layout layout_;
  Eigen::MatrixXd Q_;
  Eigen::VectorXd g_;
};

}  // namespace dynamic_icp::window
