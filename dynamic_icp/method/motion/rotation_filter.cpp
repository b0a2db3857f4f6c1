// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/motion/rotation_filter.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::motion {
namespace {

// Keeps the covariance invertible where a direction is known almost exactly.
constexpr double kMinVariance = 1e-14;

// The process noise follows the last scans with this weight for the newest, within bounds.
constexpr double kProcessNoiseGain = 0.2;
constexpr double kMinProcessNoise = 0.01;
constexpr double kMaxProcessNoise = 100.0;

/// Variance ((rad/s^2)^2) of the change that noise makes to the angular acceleration in `dt_s`.
double variance_of_change(double process_noise, double dt_s, const RotationFilterConfig& config) {
  const double fade = std::exp(-dt_s / config.alpha_time_s);
  return process_noise * config.alpha_rad_s2 * config.alpha_rad_s2 * (1.0 - fade * fade);
}

/// Normalised innovation squared over its degrees of freedom: 1 on average where the prediction's covariance is right.
double innovation(const RotationState& found, const RotationState& predicted) {
  Vector9d e;
  e << log_so3(found.R_map_sensor * predicted.R_map_sensor.transpose()), found.omega - predicted.omega,
      found.alpha - predicted.alpha;
  return e.dot(predicted.covariance.ldlt().solve(e)) / static_cast<double>(e.size());
}

}  // namespace

RotationState first_rotation_state(const RotationFilterConfig& config) {
  RotationState state;
  state.covariance.diagonal().setConstant(kMinVariance);
  state.covariance.diagonal().segment<3>(3).setConstant(config.start_omega_rad_s * config.start_omega_rad_s);
  state.covariance.diagonal().tail<3>().setConstant(config.alpha_rad_s2 * config.alpha_rad_s2);
  return state;
}

RotationState predict(const RotationState& state, double dt_s, const RotationFilterConfig& config) {
  const double fade = std::exp(-dt_s / config.alpha_time_s);
  RotationState next;
  next.R_map_sensor = state.R_map_sensor * exp_so3(dt_s * state.omega + 0.5 * dt_s * dt_s * state.alpha);
  next.omega = state.omega + dt_s * state.alpha;
  next.alpha = fade * state.alpha;

  Matrix9d F = Matrix9d::Identity();
  F.block<3, 3>(0, 3) = dt_s * next.R_map_sensor;
  F.block<3, 3>(0, 6) = 0.5 * dt_s * dt_s * next.R_map_sensor;
  F.block<3, 3>(3, 6) = dt_s * Eigen::Matrix3d::Identity();
  F.block<3, 3>(6, 6) = fade * Eigen::Matrix3d::Identity();
  // A change of alpha that grows evenly over the step: by 1 at its end, by dt/2 in omega, by dt^2/6 in the rotation.
  Eigen::Matrix<double, 9, 3> G;
  G << dt_s * dt_s / 6.0 * next.R_map_sensor, 0.5 * dt_s * Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity();
  const double driving = variance_of_change(state.process_noise, dt_s, config);
  next.process_noise = state.process_noise;
  next.covariance = F * state.covariance * F.transpose() + driving * G * G.transpose();
  next.covariance.diagonal().array() += kMinVariance;
  return next;
}

}  // namespace dynamic_icp::motion
