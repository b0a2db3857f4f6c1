// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/ego_motion/ego_filter.hpp"

#include <cmath>
#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

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
  const Matrix7d root = ego.joint_covariance.llt().matrixL();
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

}  // namespace
}  // namespace dynamic_icp::ego_motion
