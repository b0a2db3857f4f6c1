// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <random>

#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/tracking/body_filter.hpp"

#include "testing/dense_algebra.hpp"

// States of the filter of a body, to ask them for derivatives.
namespace dynamic_icp::tracking {

/// Position (m), velocity (m/s), yaw (rad), yaw rate (rad/s), and the faces of some car.
inline BodyFilter::Vector state_of(const Eigen::Vector3d& p, const Eigen::Vector3d& v, double yaw, double yaw_rate) {
  BodyFilter::Vector x;
  x << p, v, yaw, yaw_rate, 0.0, 2.4, 2.0, 0.8, 1.0, 1.1, 0.4;
  return x;
}

/// On level ground; all standard deviations are `sigma`.
inline BodyFilter body_with(const Eigen::Vector3d& p, const Eigen::Vector3d& v, double yaw_rate, double sigma = 1.0) {
  return {state_of(p, v, 0.0, yaw_rate), sigma * sigma * BodyFilter::Matrix::Identity(), Eigen::Matrix3d::Identity()};
}

/// A body in general motion on a slope, everything correlated with everything.
inline BodyFilter any_body(std::uint64_t seed) {
  std::mt19937 random(static_cast<std::mt19937::result_type>(seed));
  const BodyFilter::Matrix root = dense::random_matrix(random, BodyFilter::kStates, BodyFilter::kStates);
  BodyFilter::Vector x = state_of({30, 8, 1}, {4, 9, 0.3}, 1.1, 0.4) + 0.1 * root.col(0);
  x[BodyFilter::kAcceleration] = 1.2;
  return {x, 0.02 * root * root.transpose(), exp_so3({0.1, -0.15, 0.3})};
}

inline BodyFilter with_state(const BodyFilter& body, const BodyFilter::Vector& x) {
  return {x, body.covariance(), body.level()};
}

/// Rows of derivatives of a function by the state, by central differences.
template <int kRows>
Eigen::Matrix<double, kRows, BodyFilter::kStates> derivatives(
    const std::function<Eigen::Matrix<double, kRows, 1>(const BodyFilter::Vector&)>& function,
    const BodyFilter::Vector& x) {
  constexpr double kStep = 1e-5;
  Eigen::Matrix<double, kRows, BodyFilter::kStates> J;
  for (int i = 0; i < BodyFilter::kStates; ++i) {
    J.col(i) = (function(x + kStep * BodyFilter::Vector::Unit(i)) - function(x - kStep * BodyFilter::Vector::Unit(i))) /
               (2.0 * kStep);
  }
  return J;
}

}  // namespace dynamic_icp::tracking
