// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/odometry/turn_filter.hpp"

#include <array>
#include <cmath>

#include "dynamic_icp/base/se3.hpp"

namespace dynamic_icp::odometry {
namespace {

// Keeps the covariance invertible where a direction is known almost exactly.
constexpr double kLeastVariance = 1e-14;

}  // namespace

ConfigFields fields(TurnFilterConfig& config) {
  return {
      {"start_omega_rad_s", &config.start_omega_rad_s, 1e-3, 100.0, "rad/s",
       "deviation of the rate of turn at the first scan"},
      {"alpha_rad_s2", &config.alpha_rad_s2, 1e-3, 1000.0, "rad/s^2", "deviation of the angular acceleration"},
      {"alpha_time_s", &config.alpha_time_s, 1e-2, 100.0, "s", "how long an angular acceleration lasts"},
  };
}

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
  const double driving = config.alpha_rad_s2 * config.alpha_rad_s2 * (1.0 - fade * fade);
  next.covariance = F * state.covariance * F.transpose() + driving * G * G.transpose();
  next.covariance.diagonal().array() += kLeastVariance;
  return next;
}

TurnState turn_state(const registration::MapAlignment& alignment) {
  TurnState state;
  state.R_map_sensor = alignment.T_map_sensor.linear();
  state.omega = alignment.sweep.omega;
  state.alpha = alignment.sweep.alpha;
  constexpr std::array<int, 9> kRows = {0, 1, 2, 6, 7, 8, 9, 10, 11};
  state.covariance = alignment.covariance(kRows, kRows);
  return state;
}

}  // namespace dynamic_icp::odometry
