// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/turn_filter.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::odometry {
namespace {

using Eigen::Vector3d;

TEST(TurnFilter, FollowsAConstantTurn) {
  TurnState state = first_turn_state({});
  state.omega = {0.0, 0.0, 0.6};
  const TurnState later = predict(state, 0.5, {});
  EXPECT_LT(rotation_angle(later.R_map_sensor.transpose() * exp_so3(Vector3d(0.0, 0.0, 0.3))), 1e-12);
  EXPECT_EQ(later.omega, state.omega);
}

TEST(TurnFilter, LinearisesItsOwnPrediction) {
  // The covariance of a small deviation that goes through the prediction, against the difference of two predictions.
  TurnFilterConfig config;
  TurnState state = first_turn_state(config);
  state.R_map_sensor = exp_so3(Vector3d(0.2, -0.1, 0.7));
  state.omega = {0.1, -0.2, 0.4};
  state.alpha = {0.5, 0.1, -0.3};
  constexpr double kStep = 1e-6;
  constexpr double kDt = 0.1;
  const TurnState later = predict(state, kDt, config);
  for (int k = 0; k < 9; ++k) {
    registration::Vector9d d = registration::Vector9d::Zero();
    d[k] = kStep;
    TurnState moved = state;
    moved.R_map_sensor = exp_so3(d.head<3>()) * state.R_map_sensor;
    moved.omega += d.segment<3>(3);
    moved.alpha += d.tail<3>();
    const TurnState moved_later = predict(moved, kDt, config);
    registration::Vector9d change;
    change << log_so3(moved_later.R_map_sensor * later.R_map_sensor.transpose()), moved_later.omega - later.omega,
        moved_later.alpha - later.alpha;
    // With only this deviation in the covariance, what comes out is change change^T plus the driving noise.
    TurnState sure = state;
    sure.covariance.setZero();
    TurnState one = sure;
    one.covariance = 1e12 * d * d.transpose();
    const registration::Matrix9d carried = predict(one, kDt, config).covariance - predict(sure, kDt, config).covariance;
    EXPECT_LT((carried - 1e12 * change * change.transpose()).norm(), 0.02 * carried.norm() + 1e-9) << k;
  }
}

TEST(TurnFilter, KeepsTheDeviationOfTheAngularAcceleration) {
  TurnFilterConfig config;
  TurnState state = first_turn_state(config);
  for (int k = 0; k < 100; ++k) {
    state = predict(state, 0.1, config);
  }
  EXPECT_NEAR(std::sqrt(state.covariance(6, 6)), config.alpha_rad_s2, 1e-6);
  EXPECT_EQ(state.covariance.ldlt().info(), Eigen::Success);
  EXPECT_TRUE(state.covariance.ldlt().isPositive());
}

}  // namespace
}  // namespace dynamic_icp::odometry
