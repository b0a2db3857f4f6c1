// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/window/doppler_terms.hpp"
#include "dynamic_icp/method/window/learned_variance.hpp"
#include "dynamic_icp/method/window/rest_factor.hpp"
#include "dynamic_icp/method/window/spline_trajectory.hpp"
#include "dynamic_icp/method/window/window_config.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::window {

/// Weights of s_k to s_{k+3} in the jerk that is noise, 1/s^3.
std::array<double, 4> jerk_weights(double knot_spacing_s);

/// What is known of the motion before anything is measured. The coefficients of the trajectory are the sum c = s + v of
///   a smooth motion s: white noise on jerk and accelerations that last two seconds (Singer),
///     a_k = (s_{k+2} - 2 s_{k+1} + s_k) / h^2, (a_{k+1} - exp(-h / 2 s) a_k) / h ~ N(0, q),
///   a vibration v: a damped resonator driven by white noise, v_k - a_1 v_{k-1} - a_2 v_{k-2} ~ N(0, r),
/// each axis with its own variances, learned scan by scan. The vibration is an unknown of the window
/// like the coefficients; nothing but this prior knows of it.
class MotionPrior {
 public:
  explicit MotionPrior(const WindowConfig& config);

  /// Adds the terms of coefficient `first_new + 3` and later ones; 0: of all, and how a vibration may begin.
  void add(const SplineTrajectory& trajectory, std::size_t first_new, const Layout& layout, Eigen::MatrixXd& H,
           Eigen::VectorXd& g) const;

  /// Learns from the intervals [begin, end) by MacKay's fixed point q = sum e^2 / sum (1 - Var e / q). `factor` is that
  /// of the information of all unknowns but theta. May be called again with a better estimate before `keep`.
  void learn(const SplineTrajectory& trajectory, std::size_t begin, std::size_t end, const Layout& layout,
             const RestFactor& factor);
  void keep();

  void state(StateArchive& archive);

  [[nodiscard]] Vector6d jerk_variance() const;       ///< q, [rad/s^3; m/s^3] squared
  [[nodiscard]] Vector6d vibration_variance() const;  ///< of v, [rad; m] squared

 private:
  std::array<double, 2> resonator_;  ///< a_1 and a_2
  double gain_ = 1.0;                ///< variance of v over r
  std::array<LearnedVariance, 6> jerk_;
  std::array<LearnedVariance, 6> vibration_;
};

}  // namespace dynamic_icp::window
