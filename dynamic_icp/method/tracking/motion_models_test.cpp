// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/motion_models.hpp"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

#include "testing/filtered_body.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

double density(double value, double mean, double variance) {
  return std::exp(-0.5 * (value - mean) * (value - mean) / variance) / std::sqrt(variance);
}

/// What is known of the models after 3 s of scans of a body that moves so, with the noise of a scan.
MotionProbabilities after_3_s(double speed_mps, double yaw_rate_rps) {
  constexpr double kVelocity_mps = 0.05;
  constexpr double kYawRate_rps = 0.05;
  BodyFilter body = body_with({30, 8, 0}, {0.5, 0, 0}, 0.0, 2.0);
  MotionModels models;
  const RandomSource random(7);
  double yaw = 0.0;
  for (std::uint64_t k = 0; k < 30; ++k) {
    body.predict(0.1, {});
    models.predict(0.1);
    const BodyFilter before = body;
    yaw += 0.1 * yaw_rate_rps;
    const Vector3d noise(random.normal(4 * k), random.normal(4 * k + 1), random.normal(4 * k + 2));
    ClusterVelocity measured;
    measured.W = speed_mps * Vector3d(std::cos(yaw), std::sin(yaw), 0.0) + kVelocity_mps * noise -
                 yaw_rate_rps * Vector3d::UnitZ().cross(body.position());
    measured.information = Matrix3d::Identity() / (kVelocity_mps * kVelocity_mps);
    body.correct_yaw_rate(yaw_rate_rps + kYawRate_rps * random.normal(4 * k + 3), kYawRate_rps * kYawRate_rps);
    body.correct_doppler(measured, Vector3d::Zero(), Matrix3d::Zero());
    body.correct_yaw(yaw, 0.01);
    models.correct(before, body);
  }
  return models.probabilities();
}

TEST(MotionModels, TellStandingFromStraightAndTurning) {
  EXPECT_GT(after_3_s(0.0, 0.0).standing, 0.9);
  EXPECT_GT(after_3_s(9.0, 0.0).straight, 0.8);
  EXPECT_GT(after_3_s(9.0, 0.3).turning, 0.99);
  EXPECT_LT(after_3_s(1.0, 0.0).standing, 0.01);
}

TEST(MotionModels, ARatioOfDensitiesIsThatOfTheLikelihoodsOfAMeasurement) {
  // Of a yaw rate, by the filter with and without the constraint that it does not turn.
  BodyFilter before = body_with({30, 8, 0}, {9, 0, 0}, 0.08, 0.1);
  constexpr double kVariance = 0.03 * 0.03;
  for (const double seen : {-0.02, 0.01, 0.1}) {
    BodyFilter after = before;
    after.correct_yaw_rate(seen, kVariance);
    MotionModels models;
    models.correct(before, after);
    BodyFilter straight = before;
    constrain(MotionModel::kStraight, straight);
    const auto likelihood = [&](const BodyFilter& body) {
      const double variance = body.covariance()(BodyFilter::kYawRate, BodyFilter::kYawRate) + kVariance;
      return density(seen, body.yaw_rate(), variance);
    };
    const MotionProbabilities& found = models.probabilities();
    EXPECT_NEAR(found.straight / found.turning, likelihood(straight) / likelihood(before), 1e-9);
    EXPECT_NEAR(found.standing + found.straight + found.turning, 1.0, 1e-12);
  }
}

TEST(MotionModels, WithoutMeasurementsAnyBecomesAsLikely) {
  MotionModels models;
  BodyFilter before = body_with({30, 8, 0}, {0, 0, 0}, 0.0, 1.0);
  const BodyFilter after = body_with({30, 8, 0}, {0, 0, 0}, 0.0, 0.01);
  models.correct(before, after);
  const double standing = models.probabilities().standing;
  EXPECT_GT(standing, 0.4);
  models.predict(1.0);
  const double kept = std::exp(-1.0 / 5.0);
  EXPECT_NEAR(models.probabilities().standing, kept * standing + 0.5 * (1.0 - kept) * (1.0 - standing), 1e-12);
  for (int i = 0; i < 100; ++i) {
    models.predict(i % 2 == 0 ? 1.0 : -1.0);
  }
  EXPECT_NEAR(models.probabilities().standing, 1.0 / 3.0, 1e-6);
  EXPECT_NEAR(models.probabilities().turning, 1.0 / 3.0, 1e-6);
}

TEST(MotionModels, ABodyThatFollowsOneObeysIt) {
  BodyFilter body = any_body(3);
  constrain(MotionModel::kTurning, body);
  EXPECT_EQ(body.state(), any_body(3).state());
  constrain(MotionModel::kStraight, body);
  EXPECT_NEAR(body.yaw_rate(), 0.0, 0.02);
  BodyFilter standing = body_with({30, 8, 0}, {0.2, 0.1, 0}, 0.05, 0.5);
  constrain(MotionModel::kStanding, standing);
  EXPECT_LT(standing.velocity().norm(), 0.05);
  standing.predict(1.0, noise_under(MotionModel::kStanding, {}));
  EXPECT_LT((standing.position() - Vector3d(30, 8, 0)).norm(), 0.25);
  EXPECT_EQ(noise_under(MotionModel::kStraight, {}).yaw_rate_rps, 0.0);
  EXPECT_EQ(noise_under(MotionModel::kTurning, {}).yaw_rate_rps, MotionNoise{}.yaw_rate_rps);
}

}  // namespace
}  // namespace dynamic_icp::tracking
