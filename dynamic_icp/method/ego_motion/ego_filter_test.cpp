// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/ego_filter.hpp"

#include <cmath>
#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "testing/dense_algebra.hpp"

namespace dynamic_icp::ego_motion {
namespace {

EgoVelocity braking() {
  EgoVelocity ego;
  ego.velocity_sensor = {20.0, 0.5, -0.1};
  ego.acceleration_sensor = {-3.0, 0.2, 0.0};
  ego.bias_mps = 0.1;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const Matrix7d A = Matrix7d::NullaryExpr([&] { return 0.1 * normal(random); });
  ego.joint_covariance = A * A.transpose() + 1e-3 * Matrix7d::Identity();
  ego.covariance = ego.joint_covariance.topLeftCorner<3, 3>();
  return ego;
}

TEST(EgoFilter, CarriesTheVelocityOnWithItsAcceleration) {
  const EgoPrior prior = predict(braking(), 0.2, {});
  EXPECT_TRUE(prior.has_velocity);
  EXPECT_NEAR(prior.mean[0], 19.4, 1e-12);
  EXPECT_NEAR(prior.mean[1], 0.54, 1e-12);
  EXPECT_NEAR(prior.mean[3], -3.0, 1e-12);
  EXPECT_NEAR(prior.mean[6], 0.1, 1e-12);
}

TEST(EgoFilter, CarriesTheCovarianceOfSampledMotions) {
  const EgoVelocity ego = braking();
  DriftConfig config;
  config.jerk_mps3 = 20.0;
  config.bias_drift_mps = 0.5;
  constexpr double kDt = 0.2;
  const EgoPrior prior = predict(ego, kDt, config);
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  const Matrix7d root = dense::cholesky_root(ego.joint_covariance);
  Matrix7d sum = Matrix7d::Zero();
  constexpr int kDraws = 40000;
  for (int k = 0; k < kDraws; ++k) {
    Vector7d x = root * Vector7d::NullaryExpr([&] { return normal(random); });
    for (int axis = 0; axis < 3; ++axis) {
      const double jerk = config.jerk_mps3 * normal(random);
      x[axis] += kDt * x[axis + 3] + 0.5 * jerk * kDt * kDt;
      x[axis + 3] += jerk * kDt;
    }
    x[6] += config.bias_drift_mps * std::sqrt(kDt) * normal(random);
    sum += x * x.transpose() / kDraws;
  }
  EXPECT_LT((sum - prior.covariance).norm(), 0.03 * prior.covariance.norm());
}

TEST(EgoFilter, KnowsNoVelocityWhereNoneWasStated) {
  EXPECT_FALSE(first_prior({}).has_velocity);
  EgoVelocity nothing;
  EXPECT_FALSE(predict(nothing, 0.1, {}).has_velocity);
}

/// An estimate whose velocity goes with the bias, as in a narrow view.
EgoVelocity narrow_view(double bias, double sigma) {
  EgoVelocity ego;
  ego.velocity_sensor = {10.0 + bias, 0.0, 0.0};
  ego.bias_mps = bias;
  ego.bias_variance = sigma * sigma;
  Vector7d direction = Vector7d::Zero();
  direction[0] = direction[6] = 1.0;
  ego.joint_covariance = ego.bias_variance * direction * direction.transpose() + 1e-6 * Matrix7d::Identity();
  ego.joint_covariance(6, 6) = ego.bias_variance;
  ego.covariance = ego.joint_covariance.topLeftCorner<3, 3>();
  return ego;
}

TEST(WeighCalibration, PresumesNoBiasThatNobodySaw) {
  // As wide as before any scan: nothing was learned, each case is worth one half.
  const EgoVelocity weighed = average_over_bias_models(narrow_view(0.1, 0.2), {});
  EXPECT_GT(weighed.velocity_sensor.x(), 10.03);
  EXPECT_LT(weighed.velocity_sensor.x(), 10.07);
  EXPECT_GT(std::sqrt(weighed.covariance(0, 0)), 0.1) << "both cases are still open";
}

TEST(WeighCalibration, BelievesAZeroThatWasSeen) {
  const EgoVelocity weighed = average_over_bias_models(narrow_view(0.01, 0.01), {});
  EXPECT_LT(std::abs(weighed.bias_mps), 0.002);
  EXPECT_NEAR(weighed.velocity_sensor.x(), 10.0, 0.002);
  EXPECT_LT(weighed.covariance(0, 0), narrow_view(0.01, 0.01).covariance(0, 0));
}

TEST(WeighCalibration, LeavesABiasThatWasSeenAlone) {
  const EgoVelocity seen = narrow_view(0.2, 0.01);
  const EgoVelocity weighed = average_over_bias_models(seen, {});
  EXPECT_NEAR(weighed.bias_mps, 0.2, 1e-6);
  EXPECT_LT((weighed.covariance - seen.covariance).norm(), 1e-6);
  EgoVelocity none = seen;
  none.bias_variance = 0.0;
  EXPECT_EQ(average_over_bias_models(none, {}).velocity_sensor, none.velocity_sensor);
}

TEST(WeighCalibration, IsRightOnAverage) {
  // Half of the sensors calibrated, half with a bias: the stated covariance is that of the errors over many draws.
  const DriftConfig config;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  constexpr double kSeen = 0.06;  // standard deviation of what the data say of the bias
  double squares = 0.0;
  double stated = 0.0;
  constexpr int kDraws = 20000;
  for (int k = 0; k < kDraws; ++k) {
    const double bias = k % 2 == 0 ? 0.0 : config.start_bias_mps * normal(random);
    const double presumed = 1.0 / (config.start_bias_mps * config.start_bias_mps);
    const double information = 1.0 / (kSeen * kSeen);
    const double posterior = (bias + kSeen * normal(random)) * information / (information + presumed);
    const EgoVelocity weighed =
        average_over_bias_models(narrow_view(posterior, 1.0 / std::sqrt(information + presumed)), config);
    squares += std::pow(weighed.velocity_sensor.x() - 10.0 - bias, 2);
    stated += weighed.covariance(0, 0);
  }
  EXPECT_NEAR(stated / squares, 1.0, 0.1);
}

}  // namespace
}  // namespace dynamic_icp::ego_motion
