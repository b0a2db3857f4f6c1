// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/consensus_regression.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "dynamic_icp/method/ego_motion/doppler_regression.hpp"
#include "dynamic_icp/method/ego_motion/ego_filter.hpp"

namespace dynamic_icp::ego_motion {
namespace {

using Eigen::Vector3d;

/// A scene from equations: a road between far walls, and boxes around the sensor that move with one velocity.
struct Scene {
  Vector3d v{8.0, 0.3, -0.2};                // of the sensor
  Vector3d a = Vector3d::Zero();             // its change, m/s^2
  Vector3d dynamic_outliers{3.0, 0.0, 0.0};  // velocity of the boxes over ground
  double dynamic_share = 0.0;                // of the points
  double bias = 0.0;
  double noise = 0.05;
  double outlier_share = 0.005;
  double half_width = 1.05;  // of the field of view, rad
  double half_height = 0.17;
  double sweep_s = 0.0;  // from right to left
  std::size_t points = 8000;
};

class Caster {
 public:
  Caster(const Scene& scene, unsigned seed) : scene_(scene), random_(seed) {}

  Scan scan() {
    RawScan raw;
    const auto dynamic_outliers = static_cast<std::size_t>(scene_.dynamic_share * static_cast<double>(scene_.points));
    for (std::size_t i = 0; i < scene_.points; ++i) {
      add(raw, i < dynamic_outliers ? box_point() : world_point(), i < dynamic_outliers);
    }
    return Scan::from_raw(raw);
  }

 private:
  double uniform(double low, double high) { return low + (high - low) * uniform_(random_); }

  Vector3d direction() {
    const double azimuth = uniform(-scene_.half_width, scene_.half_width);
    const double elevation = uniform(-scene_.half_height, scene_.half_height);
    return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
  }

  // The nearest of ground (z = -1.8 m), walls (y = -25 m, y = 25 m) and a wall ahead (x = 80 m).
  Vector3d world_point() {
    const Vector3d u = direction();
    double range = 80.0 / std::max(1e-3, u.x());
    range = std::min(range, 25.0 / std::max(1e-3, std::abs(u.y())));
    range = u.z() < 0.0 ? std::min(range, 1.8 / -u.z()) : range;
    return range * u;
  }

  // On the near and the inner face of one of six boxes, 4 x 1.8 x 1.5 m, in two lanes beside the sensor and one ahead.
  Vector3d box_point() {
    const double box = std::floor(uniform(0.0, 6.0));
    const double x = 5.0 + 6.0 * std::floor(box / 2.0);
    const double side = box == 5.0 ? 0.0 : (std::fmod(box, 2.0) == 0.0 ? 1.0 : -1.0);
    const double z = uniform(-1.5, 0.0);
    if (side == 0.0 || uniform(0.0, 1.0) < 0.3) {
      return {x, side * 3.5 + uniform(-0.9, 0.9), z};
    }
    return {x + uniform(0.0, 4.0), side * 2.6, z};
  }

  void add(RawScan& raw, const Vector3d& point, bool moves) {
    const Vector3d u = point.normalized();
    const double azimuth = std::atan2(u.y(), u.x());
    const double time = scene_.sweep_s * 0.5 * (1.0 + azimuth / 1.6);
    const Vector3d v =
        scene_.v + scene_.a * (time - 0.5 * scene_.sweep_s) - (moves ? scene_.dynamic_outliers : Vector3d::Zero());
    const bool gross = uniform(0.0, 1.0) < scene_.outlier_share;
    raw.points.push_back(point);
    raw.doppler.push_back(gross ? uniform(-30.0, 30.0) : -u.dot(v) + scene_.bias + scene_.noise * normal_(random_));
    if (scene_.sweep_s > 0.0) {
      raw.times.push_back(time);
    }
  }

  Scene scene_;
  std::mt19937 random_;
  std::uniform_real_distribution<double> uniform_;
  std::normal_distribution<double> normal_;
};

Scan cast(const Scene& scene, unsigned seed) { return Caster(scene, seed).scan(); }

EgoVelocity estimate(const Scan& scan, const EgoPrior& prior = {}, const ConsensusRegressionConfig& config = {},
                     int threads = 1) {
  return estimate_velocity(scan, prior, config, Workers(threads));
}

EgoPrior prior_at(const Vector3d& velocity, double sigma = 0.5) {
  EgoPrior prior;
  prior.has_velocity = true;
  prior.mean.head<3>() = velocity;
  prior.covariance.topLeftCorner<3, 3>() = sigma * sigma * Eigen::Matrix3d::Identity();
  return prior;
}

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
  const Eigen::Vector4d expected = J.colPivHouseholderQr().solve(s);
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

TEST(ConsensusRegression, AFilterOverInstantScansFollowsHardBraking) {
  // Steady for a while, so that the filter is sure of it, then 6 m/s^2: velocity and acceleration must follow.
  Scene scene;
  scene.v = Vector3d(20.0, 0.0, 0.0);
  EgoPrior prior = first_prior({});
  EgoVelocity ego;
  for (unsigned k = 0; k < 30; ++k) {
    scene.v.x() -= k > 15 ? 0.6 : 0.0;
    ego = estimate(cast(scene, 300 + k), prior);
    EXPECT_LT((ego.velocity_sensor - scene.v).norm(), 0.05) << k;
    prior = predict(ego, 0.1, {});
  }
  EXPECT_NEAR(ego.acceleration_sensor.x(), -6.0, 0.5);
}

TEST(ConsensusRegression, SaysWhatAFirstScanLeavesOpen) {
  Scene scene;
  scene.half_height = 0.0;
  const EgoVelocity ego = estimate(cast(scene, 7));
  EXPECT_EQ(ego.status, EgoVelocityStatus::kDegenerate);
  EXPECT_GT(ego.covariance(2, 2), 100.0);
  EXPECT_LT(ego.covariance(0, 0), 0.05);
}

TEST(ConsensusRegression, KeepsThePriorAlongWhatNobodySees) {
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

TEST(ConsensusRegression, TellsABiasFromTheVelocityInAWideView) {
  Scene scene;
  scene.bias = 0.2;
  const EgoVelocity ego = estimate(cast(scene, 8));
  EXPECT_NEAR(ego.bias_mps, 0.2, 4.0 * std::sqrt(ego.bias_variance));
  EXPECT_LT(std::sqrt(ego.bias_variance), 0.02);
  EXPECT_LT((ego.velocity_sensor - scene.v).norm(), 0.04);
  // Switched off, the velocity takes the bias over.
  ConsensusRegressionConfig config;
  config.estimate_bias = false;
  const EgoVelocity without = estimate(cast(scene, 8), {}, config);
  EXPECT_EQ(without.bias_mps, 0.0);
  EXPECT_EQ(without.bias_variance, 0.0);
  EXPECT_GT((without.velocity_sensor - scene.v).norm(), 0.15);
}

TEST(ConsensusRegression, InANarrowViewTheCovarianceTellsThatABiasMayHide) {
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

TEST(ConsensusRegression, SolvesForTheAccelerationDuringASweep) {
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

TEST(ConsensusRegression, CovarianceCoversTheTrueError) {
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
