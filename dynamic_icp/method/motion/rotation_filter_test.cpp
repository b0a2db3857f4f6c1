// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/motion/rotation_filter.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "dynamic_icp/method/base/se3.hpp"

#include "testing/dense_algebra.hpp"

namespace dynamic_icp::motion {
namespace {

using Eigen::Vector3d;

TEST(RotationFilter, FollowsAConstantTurn) {
  RotationState state = first_rotation_state({});
  state.omega = {0.0, 0.0, 0.6};
  const RotationState later = predict(state, 0.5, {});
  EXPECT_LT(rotation_angle(later.R_map_sensor.transpose() * exp_so3(Vector3d(0.0, 0.0, 0.3))), 1e-12);
  EXPECT_EQ(later.omega, state.omega);
}

TEST(RotationFilter, LinearisesItsOwnPrediction) {
  // The covariance of a small standard deviation that goes through the prediction, against the difference of two
  // predictions.
  RotationFilterConfig config;
  RotationState state = first_rotation_state(config);
  state.R_map_sensor = exp_so3(Vector3d(0.2, -0.1, 0.7));
  state.omega = {0.1, -0.2, 0.4};
  state.alpha = {0.5, 0.1, -0.3};
  constexpr double kStep = 1e-6;
  constexpr double kDt = 0.1;
  const RotationState later = predict(state, kDt, config);
  for (int k = 0; k < 9; ++k) {
    Vector9d d = Vector9d::Zero();
    d[k] = kStep;
    RotationState moved = state;
    moved.R_map_sensor = exp_so3(d.head<3>()) * state.R_map_sensor;
    moved.omega += d.segment<3>(3);
    moved.alpha += d.tail<3>();
    const RotationState moved_later = predict(moved, kDt, config);
    Vector9d change;
    change << log_so3(moved_later.R_map_sensor * later.R_map_sensor.transpose()), moved_later.omega - later.omega,
        moved_later.alpha - later.alpha;
    // With only this standard deviation in the covariance, what comes out is change change^T plus the driving noise.
    RotationState sure = state;
    sure.covariance.setZero();
    RotationState one = sure;
    one.covariance = 1e12 * d * d.transpose();
    const Matrix9d carried = predict(one, kDt, config).covariance - predict(sure, kDt, config).covariance;
    EXPECT_LT((carried - 1e12 * change * change.transpose()).norm(), 0.02 * carried.norm() + 1e-9) << k;
  }
}

TEST(RotationFilter, KeepsTheDeviationOfTheAngularAcceleration) {
  RotationFilterConfig config;
  RotationState state = first_rotation_state(config);
  for (int k = 0; k < 100; ++k) {
    state = predict(state, 0.1, config);
  }
  EXPECT_NEAR(std::sqrt(state.covariance(6, 6)), config.alpha_rad_s2, 1e-6);
  EXPECT_GE(dense::symmetric_parts(state.covariance).values.minCoeff(), 0.0);
}

}  // namespace
}  // namespace dynamic_icp::motion
