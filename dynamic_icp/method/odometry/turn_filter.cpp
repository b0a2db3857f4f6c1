// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/turn_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::odometry {
namespace {

// Keeps the covariance invertible where a direction is known almost exactly.
constexpr double kLeastVariance = 1e-14;

// A parabola fitted to a turn whose angular acceleration does a random walk, changing by 1 rad/s^2 over a sweep of 1 s,
// errs by so much at its begin: in the angle (rad) and its rate (rad/s). By simulation.
constexpr double kAngleMisfit = 0.0102;
constexpr double kRateMisfit = 0.12;

// How lively a turn is follows the last scans with this weight for the newest, within bounds.
constexpr double kLivelinessGain = 0.2;
constexpr double kLeastLiveliness = 0.01;
constexpr double kMostLiveliness = 100.0;

/// (rad/s^2)^2, of the change of the angular acceleration over a time that keeps its deviation.
double variance_of_change(double liveliness, double dt_s, const TurnFilterConfig& config) {
  const double fade = std::exp(-dt_s / config.alpha_time_s);
  return liveliness * config.alpha_rad_s2 * config.alpha_rad_s2 * (1.0 - fade * fade);
}

/// Squared distance of an alignment from its prediction, over what was expected of it: 1 on average.
double surprise(const TurnState& state, const TurnState& predicted) {
  registration::Vector9d e;
  e << log_so3(state.R_map_sensor * predicted.R_map_sensor.transpose()), state.omega - predicted.omega,
      state.alpha - predicted.alpha;
  return e.dot(predicted.covariance.ldlt().solve(e)) / static_cast<double>(e.size());
}

}  // namespace

TurnState first_turn_state(const TurnFilterConfig& config) {
  TurnState state;
  state.covariance.diagonal().setConstant(kLeastVariance);
  state.covariance.diagonal().segment<3>(3).setConstant(config.start_omega_rad_s * config.start_omega_rad_s);
  state.covariance.diagonal().tail<3>().setConstant(config.alpha_rad_s2 * config.alpha_rad_s2);
  return state;
}

TurnState predict(const TurnState& state, double dt_s, const TurnFilterConfig& config) {
  const double fade = std::exp(-dt_s / config.alpha_time_s);
  TurnState next;
  next.R_map_sensor = state.R_map_sensor * exp_so3(dt_s * state.omega + 0.5 * dt_s * dt_s * state.alpha);
  next.omega = state.omega + dt_s * state.alpha;
  next.alpha = fade * state.alpha;

  registration::Matrix9d F = registration::Matrix9d::Identity();
  F.block<3, 3>(0, 3) = dt_s * next.R_map_sensor;
  F.block<3, 3>(0, 6) = 0.5 * dt_s * dt_s * next.R_map_sensor;
  F.block<3, 3>(3, 6) = dt_s * Eigen::Matrix3d::Identity();
  F.block<3, 3>(6, 6) = fade * Eigen::Matrix3d::Identity();
  // A change of alpha that grows evenly over the step: by 1 at its end, by dt/2 in omega, by dt^2/6 in the rotation.
  Eigen::Matrix<double, 9, 3> G;
  G << dt_s * dt_s / 6.0 * next.R_map_sensor, 0.5 * dt_s * Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity();
  const double driving = variance_of_change(state.liveliness, dt_s, config);
  next.liveliness = state.liveliness;
  next.covariance = F * state.covariance * F.transpose() + driving * G * G.transpose();
  next.covariance.diagonal().array() += kLeastVariance;
  return next;
}

TurnState turn_state(const registration::MapAlignment& alignment, const TurnState& predicted, double duration_s,
                     const TurnFilterConfig& config) {
  TurnState state;
  state.R_map_sensor = alignment.T_map_sensor.linear();
  state.omega = alignment.sweep.omega;
  state.alpha = alignment.sweep.alpha;
  constexpr std::array<int, 9> kRows = {0, 1, 2, 6, 7, 8, 9, 10, 11};
  state.covariance = alignment.covariance(kRows, kRows);
  const double surprised = surprise(state, predicted);
  state.liveliness =
      std::clamp(predicted.liveliness * (1.0 + kLivelinessGain * (surprised - 1.0)), kLeastLiveliness, kMostLiveliness);
  const double now = predicted.liveliness * std::max(1.0, surprised);
  const double change = std::sqrt(variance_of_change(now, duration_s, config));
  const double angle = kAngleMisfit * change * duration_s * duration_s;
  const double rate = kRateMisfit * change * duration_s;
  state.covariance.diagonal().head<3>().array() += angle * angle;
  state.covariance.diagonal().segment<3>(3).array() += rate * rate;
  return state;
}

}  // namespace dynamic_icp::odometry
