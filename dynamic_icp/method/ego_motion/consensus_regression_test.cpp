// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/consensus_regression.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "dynamic_icp/method/ego_motion/doppler_regression.hpp"

#include "testing/crowded_road.hpp"
#include "testing/dense_algebra.hpp"

namespace dynamic_icp::ego_motion {
namespace {

using Eigen::Vector3d;

TEST(ConsensusRegression, FewerThanThreePointsGiveThePrior) {
  for (const std::size_t n : {0u, 1u, 2u}) {
    Scene scene;
    scene.points = n;
    const EgoVelocity ego = estimate(cast(scene, 1), prior_at({4.0, 0.0, 0.0}));
    EXPECT_EQ(ego.status, EgoVelocityStatus::kTooFewPoints);
    EXPECT_EQ(ego.velocity_sensor, Vector3d(4.0, 0.0, 0.0));
    EXPECT_TRUE(ego.unobservable.isIdentity());
    EXPECT_TRUE(estimate(cast(scene, 1)).velocity_sensor.isZero(0.0));
  }
}

TEST(ConsensusRegression, ThreePointsAreSolvedWithAWideCovariance) {
  RawScan raw;
  const Vector3d v(2.0, 1.0, -0.5);
  for (const Vector3d& point : {Vector3d(9, 0, 0), Vector3d(0, 9, 0), Vector3d(0, 0, 9)}) {
    raw.points.push_back(point);
    raw.doppler.push_back(-point.normalized().dot(v));
  }
  const EgoVelocity ego = estimate(Scan::from_raw(raw));
  // Nothing tells the noise of three points, nor a bias: each standard deviation is that of one point and of the bias
  // at least.
  EXPECT_LT((ego.velocity_sensor - v).norm(), 0.05);
  EXPECT_GT(ego.covariance.diagonal().minCoeff(), 0.2 * 0.2);
  EXPECT_TRUE(ego.covariance.allFinite());
}

TEST(ConsensusRegression, IsExactWithoutNoise) {
  Scene scene;
  scene.noise = 0.0;
  scene.outlier_share = 0.0;
  const EgoVelocity ego = estimate(cast(scene, 2));
  EXPECT_EQ(ego.status, EgoVelocityStatus::kConverged);
  EXPECT_LT((ego.velocity_sensor - scene.v).norm(), 1e-6);
  EXPECT_EQ(ego.inliers, scene.points);
  EXPECT_TRUE(ego.acceleration_sensor.isZero(0.0));
}

TEST(ConsensusRegression, IsCloseToLeastSquaresInAStaticScene) {
  Scene scene;
  scene.outlier_share = 0.0;
  const Scan scan = cast(scene, 3);
  const auto n = static_cast<Eigen::Index>(scan.size());
  Eigen::MatrixX4d J(n, 4);
  Eigen::VectorXd s(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    J.row(i) << -scan.directions()[static_cast<std::size_t>(i)].transpose(), 1.0;
    s[i] = scan.doppler()[static_cast<std::size_t>(i)];
  }
  const Eigen::Vector4d expected = dense::least_squares(J, s);
  const EgoVelocity ego = estimate(scan);
  // Tukey's estimate differs from least squares by a fraction of the standard deviation of either.
  const Eigen::Matrix4d covariance = 0.05 * 0.05 * (J.transpose() * J).inverse();
  const Vector3d difference = ego.velocity_sensor - expected.head<3>();
  EXPECT_LT(difference.dot(covariance.topLeftCorner<3, 3>().inverse() * difference), 1.0);
  EXPECT_NEAR(ego.inlier_rms_mps, 0.05, 0.002);
}

TEST(ConsensusRegression, FindsTheStaticSceneBehindACrowdOnTheFirstScan) {
  for (const Vector3d& dynamic_outliers :
       {Vector3d(3.0, 0.0, 0.0), Vector3d(-2.0, 0.5, 0.0), Vector3d(8.0, 0.3, -0.2), Vector3d(0.0, 1.5, 0.0)}) {
    for (unsigned seed = 0; seed < 10; ++seed) {
      Scene scene;
      scene.dynamic_outliers = dynamic_outliers;
      scene.dynamic_share = 0.7;
      const Scan scan = cast(scene, 100 + seed);
      const EgoVelocity ego = estimate(scan);
      EXPECT_EQ(ego.status, EgoVelocityStatus::kConverged) << dynamic_outliers.transpose();
      EXPECT_LT((ego.velocity_sensor - scene.v).norm(), 0.05) << dynamic_outliers.transpose();
      const EgoVelocity huber = estimate_velocity(scan, Vector3d::Zero(), DopplerRegressionConfig{}, Workers(1));
      EXPECT_GT((huber.velocity_sensor - scene.v).norm(), 0.3) << "the scene must be a hard one";
    }
  }
}

TEST(ConsensusRegression, CrowdsThatCreepBendItLittle) {
  Scene scene;
  scene.dynamic_outliers = Vector3d(0.3, 0.0, 0.0);
  scene.dynamic_share = 0.7;
  double squared = 0.0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    squared += (estimate(cast(scene, 200 + seed)).velocity_sensor - scene.v).squaredNorm() / 10.0;
  }
  EXPECT_LT(std::sqrt(squared), 0.04) << "a tenth of what least squares would be off";
}

TEST(ConsensusRegression, TwoHalvesOfTheSceneAreAmbiguousUntilThePriorDecides) {
  // Everything on the left moves by 2 m/s against everything on the right: either may be the ground.
  Scene scene;
  const Scan whole = cast(scene, 4);
  RawScan raw;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const Vector3d& u = whole.directions()[i];
    raw.points.push_back(whole.points()[i]);
    raw.doppler.push_back(whole.doppler()[i] + (u.y() > 0.0 ? 2.0 * u.x() : 0.0));
  }
  const Scan scan = Scan::from_raw(raw);
  EXPECT_EQ(estimate(scan).status, EgoVelocityStatus::kAmbiguous);
  const Vector3d other = scene.v - Vector3d(2.0, 0.0, 0.0);
  for (const Vector3d& v : {scene.v, other}) {
    const EgoVelocity ego = estimate(scan, prior_at(v + Vector3d(0.2, -0.1, 0.1)));
    EXPECT_EQ(ego.status, EgoVelocityStatus::kConverged);
    EXPECT_LT((ego.velocity_sensor - v).norm(), 0.1);
  }
}

TEST(ConsensusRegression, WhereVotesDoNotDecideTheExpectedVelocityIsTaken) {
  // As above, but the part that agrees with the prior has fewer votes by any amount.
  const Scene scene;
  const Scan whole = cast(scene, 4);
  int ambiguous = 0;
  for (int k = 0; k <= 20; ++k) {
    RawScan raw;
    for (std::size_t i = 0; i < whole.size(); ++i) {
      const Vector3d& u = whole.directions()[i];
      raw.points.push_back(whole.points()[i]);
      raw.doppler.push_back(whole.doppler()[i] + (u.y() > -0.04 * k ? 2.0 * u.x() : 0.0));
    }
    const EgoVelocity ego = estimate(Scan::from_raw(raw), prior_at(scene.v, 0.1));
    if (ego.status == EgoVelocityStatus::kAmbiguous) {
      ++ambiguous;
      EXPECT_LT((ego.velocity_sensor - scene.v).norm(), 0.3) << k;
    }
  }
  EXPECT_GE(ambiguous, 1);
}

TEST(ConsensusRegression, ANarrowViewDoesNotBendTowardsTraffic) {
  // Ahead between boxes a little of the scene is seen: a velocity upwards, which that hardly shows, explains part of
  // what creeps, too.
  Scene scene;
  scene.half_width = 0.3;
  scene.half_height = 0.05;
  scene.noise = 0.14;
  scene.dynamic_share = 0.93;
  scene.dynamic_outliers = Vector3d(0.7, 0.0, 0.0);
  double squared = 0.0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const EgoVelocity ego = estimate(cast(scene, 300 + seed), prior_at(scene.v + Vector3d(0.1, -0.05, 0.1), 0.3));
    squared += (ego.velocity_sensor - scene.v).squaredNorm() / 20.0;
  }
  EXPECT_LT(std::sqrt(squared), 0.5) << "without the prior it is off by 1.6 m/s";
}

TEST(ConsensusRegression, AWrongPriorDoesNotHold) {
  Scene scene;
  scene.dynamic_share = 0.5;
  const EgoVelocity ego = estimate(cast(scene, 5), prior_at(scene.v - scene.dynamic_outliers));
  EXPECT_LT((ego.velocity_sensor - scene.v).norm(), 0.03);
  // And where one velocity alone explains the scan, the prior leaves no trace in it.
  scene.dynamic_share = 0.0;
  const Scan scan = cast(scene, 5);
  EXPECT_LT((estimate(scan, prior_at({-20.0, 3.0, 1.0})).velocity_sensor - estimate(scan).velocity_sensor).norm(),
            1e-3);
}

TEST(ConsensusRegression, PureOutliersAreNoVelocity) {
  Scene scene;
  scene.outlier_share = 1.0;
  const EgoVelocity first = estimate(cast(scene, 6));
  EXPECT_EQ(first.status, EgoVelocityStatus::kAmbiguous);
  EXPECT_TRUE(first.velocity_sensor.isZero(0.0));
  EXPECT_GT(first.covariance(0, 0), 100.0) << "nothing is known, and that is said";
  const EgoVelocity later = estimate(cast(scene, 6), prior_at(scene.v));
  EXPECT_EQ(later.status, EgoVelocityStatus::kAmbiguous);
  EXPECT_EQ(later.velocity_sensor, scene.v);
  EXPECT_NEAR(later.covariance(0, 0), 0.25, 1e-12);
}

TEST(ConsensusRegression, TurnsWithTheSensor) {
  Scene scene;
  scene.dynamic_share = 0.5;
  const Scan scan = cast(scene, 12);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(1.3, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  RawScan turned;
  for (const Vector3d& point : scan.points()) {
    turned.points.push_back(R * point);
  }
  turned.doppler = scan.doppler();
  // Other cells, so not the same number, but the same scene however the sensor is mounted.
  EXPECT_LT((estimate(Scan::from_raw(turned)).velocity_sensor - R * scene.v).norm(), 0.03);
}

TEST(ConsensusRegression, SameBitsForAnyNumberOfThreads) {
  Scene scene;
  scene.dynamic_share = 0.6;
  scene.sweep_s = 0.1;
  scene.points = 20'000;
  const Scan scan = cast(scene, 13);
  const EgoVelocity one = estimate(scan);
  for (const int threads : {2, 7}) {
    const EgoVelocity many = estimate(scan, {}, {}, threads);
    EXPECT_EQ(many.velocity_sensor, one.velocity_sensor);
    EXPECT_EQ(many.covariance, one.covariance);
    EXPECT_EQ(many.bias_mps, one.bias_mps);
    EXPECT_EQ(many.inliers, one.inliers);
  }
}

TEST(ConsensusRegression, StandingStillWithoutNoiseIsZero) {
  Scene scene;
  scene.v.setZero();
  scene.noise = 0.0;
  scene.outlier_share = 0.0;
  EXPECT_TRUE(estimate(cast(scene, 14)).velocity_sensor.isZero(1e-12));
}

}  // namespace
}  // namespace dynamic_icp::ego_motion
