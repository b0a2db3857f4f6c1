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

/// A prediction whose errors are independent, with the standard deviations 1e-3 rad, 1e-2 rad/s and 0.1 rad/s^2.
RotationState diagonal_prediction() {
  RotationState predicted = first_rotation_state({});
  predicted.R_map_sensor = exp_so3(Vector3d(0.2, -0.1, 0.7));
  predicted.omega = {0.1, -0.2, 0.4};
  predicted.covariance.diagonal() << Vector3d::Constant(1e-6), Vector3d::Constant(1e-4), Vector3d::Constant(1e-2);
  predicted.process_noise = 2.0;
  return predicted;
}

TEST(RotationFilter, AdaptsTheProcessNoiseToTheInnovation) {
  const RotationState predicted = diagonal_prediction();
  const auto noise_after = [&](double deviations) {
    RotationState found = predicted;
    found.R_map_sensor = exp_so3(deviations * 1e-3 * Vector3d::UnitX()) * predicted.R_map_sensor;
    found.omega += deviations * 1e-2 * Vector3d::UnitY();
    found.alpha += deviations * 0.1 * Vector3d::UnitZ();
    return updated(found, predicted, 0.1, {}).process_noise;
  };
  // Three of nine coordinates err by so many standard deviations: the normalised innovation squared is standard
  // deviations^2 / 3.
  EXPECT_NEAR(noise_after(std::sqrt(3.0)), 2.0, 1e-6) << "as expected: no change";
  EXPECT_NEAR(noise_after(0.0), 0.8 * 2.0, 1e-9);
  EXPECT_NEAR(noise_after(3.0), 2.0 * (1.0 + 0.2 * (3.0 - 1.0)), 1e-6);
  EXPECT_EQ(noise_after(1000.0), 100.0) << "bounded";
  RotationState calm = predicted;
  calm.process_noise = 0.01;
  EXPECT_EQ(updated(calm, calm, 0.1, {}).process_noise, 0.01) << "bounded";
}

TEST(RotationFilter, KeepsTheAlignmentAndAddsTheMisfitOfAParabola) {
  const RotationState predicted = diagonal_prediction();
  RotationState found = predicted;
  found.alpha += Vector3d(0.05, 0.0, 0.0);
  RotationFilterConfig config;
  const double duration_s = 0.1;
  const RotationState state = updated(found, predicted, duration_s, config);
  EXPECT_EQ(state.R_map_sensor, found.R_map_sensor);
  EXPECT_EQ(state.omega, found.omega);
  EXPECT_EQ(state.alpha, found.alpha);
  // The innovation is below 1: the process noise counts as it was predicted.
  const double fade = std::exp(-duration_s / config.alpha_time_s);
  const double change = std::sqrt(2.0 * (1.0 - fade * fade)) * config.alpha_rad_s2;
  const Matrix9d added = state.covariance - found.covariance;
  const double angle = kParabolaMisfit_rad * change * duration_s * duration_s;
  const double rate = kParabolaMisfit_rad_s * change * duration_s;
  Vector9d expected;
  expected << Vector3d::Constant(angle * angle), Vector3d::Constant(rate * rate), Vector3d::Zero();
  EXPECT_LT((added - Matrix9d(expected.asDiagonal())).norm(), 1e-9 * expected.norm());
  EXPECT_EQ(updated(found, predicted, 0.0, config).covariance, found.covariance) << "an instant has no shape";
}

// Least squares are linear: what each step of the random walk does to the fit is found by fitting what that step alone
// does to the angle, and independent steps add up by their squares.
TEST(RotationFilter, KnowsHowARandomWalkOfTheAccelerationDefeatsAParabola) {
  constexpr int kTimes = 500;
  Eigen::Matrix<double, kTimes, 3> powers;
  Eigen::Matrix<double, kTimes, 1> times;
  for (int k = 0; k < kTimes; ++k) {
    times[k] = (k + 0.5) / kTimes;
    powers.row(k) << 1.0, times[k], times[k] * times[k];
  }
  const Eigen::Matrix3d inverse = (powers.transpose() * powers).inverse();
  Vector3d variance = Vector3d::Zero();
  for (int step = 0; step < kTimes; ++step) {
    const double begin = static_cast<double>(step) / kTimes;
    // A jump of the acceleration by 1 at `begin`: its variance is the share of the step in that of the whole walk.
    const Eigen::Matrix<double, kTimes, 1> angle = 0.5 * (times.array() - begin).max(0.0).square();
    const Vector3d fitted = inverse * (powers.transpose() * angle);
    variance += fitted.cwiseAbs2() / kTimes;
  }
  EXPECT_NEAR(std::sqrt(variance[0]), std::sqrt(1.0 / 9240.0), 1e-4);
  EXPECT_NEAR(std::sqrt(variance[1]), std::sqrt(52.0 / 3465.0), 1e-3);
  EXPECT_NEAR(kParabolaMisfit_rad, std::sqrt(variance[0]), 0.03 * kParabolaMisfit_rad);
  EXPECT_NEAR(kParabolaMisfit_rad_s, std::sqrt(variance[1]), 0.03 * kParabolaMisfit_rad_s);
}

TEST(RotationFilter, FusesTheDopplerOfARigLikeAKalmanFilter) {
  RotationFilterConfig config;
  RotationState state = predict(first_rotation_state(config), 0.1, config);
  state.omega = Eigen::Vector3d(0.01, -0.02, 0.4);
  state.alpha = Eigen::Vector3d(0.1, 0.2, -0.3);
  constexpr double kAfter_s = 0.05;
  ego_motion::AngularInformation doppler;
  doppler.at << 0.0, 0.1, 0.3, 0.0, 0.0, 0.0;
  // omega is measured with 0.01 rad/s, alpha is not.
  doppler.information.topLeftCorner<3, 3>() = 1e4 * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d measured(0.02, -0.01, 0.45);
  doppler.weighted_change.head<3>() = 1e4 * (measured - doppler.at.head<3>());
  const RotationState after = fused(state, kAfter_s, doppler);

  // The same by the gain of a Kalman filter.
  Eigen::Matrix<double, 3, 9> H = Eigen::Matrix<double, 3, 9>::Zero();
  H.block<3, 3>(0, 3).setIdentity();
  H.block<3, 3>(0, 6) = kAfter_s * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d S = H * state.covariance * H.transpose() + 1e-4 * Eigen::Matrix3d::Identity();
  const Eigen::Matrix<double, 9, 3> gain = state.covariance * H.transpose() * S.inverse();
  const Vector9d change = gain * (measured - state.omega - kAfter_s * state.alpha);
  EXPECT_LT((after.omega - state.omega - change.segment<3>(3)).norm(), 1e-9);
  EXPECT_LT((after.alpha - state.alpha - change.tail<3>()).norm(), 1e-9);
  EXPECT_LT((log_so3(after.R_map_sensor * state.R_map_sensor.transpose()) - change.head<3>()).norm(), 1e-9);
  const Matrix9d covariance = (Matrix9d::Identity() - gain * H) * state.covariance;
  EXPECT_LT((after.covariance - covariance).norm(), 1e-7 * covariance.norm());

  EXPECT_EQ(fused(state, kAfter_s, {}).omega, state.omega) << "no information, no change";
}

}  // namespace
}  // namespace dynamic_icp::motion
