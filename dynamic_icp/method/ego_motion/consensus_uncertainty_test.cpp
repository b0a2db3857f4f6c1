// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// What the velocity by consensus says of its own uncertainty, and what it estimates beside it.
#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "dynamic_icp/method/ego_motion/consensus_regression.hpp"

#include "testing/crowded_road.hpp"

namespace dynamic_icp::ego_motion {
namespace {

using Eigen::Vector3d;

TEST(ConsensusUncertainty, SaysWhatAFirstScanLeavesOpen) {
  Scene scene;
  scene.half_height = 0.0;
  const EgoVelocity ego = estimate(cast(scene, 7));
  EXPECT_EQ(ego.status, EgoVelocityStatus::kDegenerate);
  EXPECT_GT(ego.covariance(2, 2), 100.0);
  EXPECT_LT(ego.covariance(0, 0), 0.05);
}

TEST(ConsensusUncertainty, KeepsThePriorAlongWhatNobodySees) {
  Scene scene;
  scene.half_height = 0.0;  // a fan: nothing is known of v_z
  scene.v.z() = 0.0;
  const EgoVelocity ego = estimate(cast(scene, 7), prior_at({7.0, 0.0, 0.7}, 0.5));
  EXPECT_EQ(ego.status, EgoVelocityStatus::kDegenerate);
  EXPECT_NEAR(ego.velocity_sensor.z(), 0.7, 1e-9);
  EXPECT_LT((ego.velocity_sensor - scene.v).head<2>().norm(), 0.05);
  EXPECT_NEAR(ego.unobservable(2, 2), 1.0, 1e-9);
  EXPECT_NEAR(ego.covariance(2, 2), 0.25, 1e-9) << "the prior's own";
  EXPECT_LT(ego.covariance(0, 0), 0.05 * 0.05);
}

TEST(ConsensusUncertainty, TellsABiasFromTheVelocityInAWideView) {
  Scene scene;
  scene.bias = 0.2;
  const EgoVelocity ego = estimate(cast(scene, 8));
  EXPECT_NEAR(ego.bias_mps, 0.2, 4.0 * std::sqrt(ego.bias_variance));
  EXPECT_LT(std::sqrt(ego.bias_variance), 0.02);
  EXPECT_LT((ego.velocity_sensor - scene.v).norm(), 0.04);
  // Ruled out, the velocity takes the bias over.
  EgoPrior calibrated;
  calibrated.covariance(6, 6) = 1e-6;
  const EgoVelocity without = estimate(cast(scene, 8), calibrated);
  EXPECT_LT(without.bias_mps, 0.01);
  EXPECT_GT((without.velocity_sensor - scene.v).norm(), 0.15);
}

TEST(ConsensusUncertainty, InANarrowViewTheCovarianceTellsThatABiasMayHide) {
  Scene scene;
  scene.half_width = 0.05;
  scene.half_height = 0.05;
  scene.bias = 0.2;
  const EgoVelocity ego = estimate(cast(scene, 9));
  EXPECT_NEAR(std::sqrt(ego.covariance(0, 0)), 0.2, 0.03) << "the prior's deviation of the bias";
  EXPECT_NEAR(ego.velocity_sensor.x(), scene.v.x() - 0.2, 0.03);
  EXPECT_TRUE(ego.covariance.allFinite());
  EgoPrior known;
  known.mean[6] = 0.2;
  known.covariance(6, 6) = 1e-6;
  const EgoVelocity told = estimate(cast(scene, 9), known);
  EXPECT_NEAR(told.velocity_sensor.x(), scene.v.x(), 0.01);
  EXPECT_LT(told.covariance(0, 0), 0.01 * 0.01);
}

TEST(ConsensusUncertainty, SolvesForTheAccelerationDuringASweep) {
  Scene scene;
  scene.sweep_s = 0.1;
  scene.a = Vector3d(4.0, -5.0, 0.0);
  scene.points = 20'000;
  EgoPrior prior;
  prior.covariance(6, 6) = 1e-6;
  const EgoVelocity ego = estimate(cast(scene, 10), prior);
  EXPECT_NEAR(ego.reference_time_s, 0.05, 1e-3);
  const Vector3d error = ego.velocity_sensor - scene.v;
  EXPECT_LT(error.dot(ego.covariance.inverse() * error), 16.0);
  EXPECT_LT(error.norm(), 0.05);
  EXPECT_LT((ego.acceleration_sensor - scene.a).head<2>().norm(), 1.5);
  // Times that all agree are no sweep.
  Scene instant = scene;
  instant.a.setZero();
  RawScan raw;
  const Scan scan = cast(instant, 10);
  raw.points = scan.points();
  raw.doppler = scan.doppler();
  raw.times.assign(scan.size(), 0.02);
  const EgoVelocity still = estimate(Scan::from_raw(raw));
  EXPECT_DOUBLE_EQ(still.reference_time_s, 0.02);
  EXPECT_TRUE(still.acceleration_sensor.isZero(0.0));
}

TEST(ConsensusUncertainty, CovarianceCoversTheTrueError) {
  struct Case {
    const char* name;
    Scene scene;
  };
  Scene plain;
  plain.points = 3000;
  Scene crowded = plain;
  crowded.dynamic_share = 0.4;
  Scene swept = plain;
  swept.sweep_s = 0.1;
  for (const Case& test : {Case{"static", plain}, Case{"crowd", crowded}, Case{"sweep", swept}}) {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    double sum = 0.0;
    constexpr int kScans = 150;
    for (unsigned k = 0; k < kScans; ++k) {
      Scene scene = test.scene;
      scene.bias = k % 2 == 0 ? 0.2 * normal(random) : 0.0;  // as the prior says: half of the sensors are calibrated
      if (scene.sweep_s > 0.0) {
        scene.a = 3.0 * Vector3d(normal(random), normal(random), normal(random));
      }
      const EgoVelocity ego = estimate(cast(scene, 1000 + k));
      const Vector3d error = ego.velocity_sensor - scene.v;
      sum += error.dot(ego.covariance.inverse() * error) / kScans;
    }
    // Three degrees of freedom; the mean of 150 scatters by 0.2.
    EXPECT_NEAR(sum, 3.0, 0.8) << test.name;
  }
}

}  // namespace
}  // namespace dynamic_icp::ego_motion
