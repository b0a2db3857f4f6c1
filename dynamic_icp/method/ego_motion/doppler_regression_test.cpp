// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/doppler_regression.hpp"

#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "testing/dense_algebra.hpp"

namespace dynamic_icp::ego_motion {
namespace {

using Eigen::Vector3d;

/// Static points in a field of view of 120 x 20 degrees seen from a sensor that moves with v; the first
/// `moving` of them get another 8 m/s.
Scan drive(unsigned seed, std::size_t n, const Vector3d& v, double noise_mps, std::size_t moving = 0) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::normal_distribution<double> normal;
  RawScan raw;
  for (std::size_t i = 0; i < n; ++i) {
    const double azimuth = 1.05 * uniform(random);
    const double elevation = 0.17 * uniform(random);
    const Vector3d u(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                     std::sin(elevation));
    raw.points.push_back((30.0 + 25.0 * uniform(random)) * u);
    raw.doppler.push_back(-u.dot(v) + noise_mps * normal(random) + (i < moving ? 8.0 : 0.0));
  }
  return Scan::from_raw(raw);
}

double huber_cost(const Scan& scan, const Vector3d& v, double delta) {
  double cost = 0.0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const double e = std::abs(scan.doppler()[i] + scan.directions()[i].dot(v));
    cost += e <= delta ? 0.5 * e * e : delta * (e - 0.5 * delta);
  }
  return cost;
}

EgoVelocity estimate(const Scan& scan, const Vector3d& prior = Vector3d::Zero(), int threads = 1) {
  return estimate_velocity(scan, prior, {}, Workers(threads));
}

TEST(DopplerRegression, IsExactWithoutNoise) {
  const Vector3d v(12.0, -0.4, 0.3);
  const EgoVelocity ego = estimate(drive(1, 500, v, 0.0));
  EXPECT_EQ(ego.status, EgoVelocityStatus::kConverged);
  EXPECT_LT((ego.velocity_sensor - v).norm(), 1e-9);
  EXPECT_EQ(ego.inliers, 500u);
}

TEST(DopplerRegression, IsOrdinaryLeastSquaresWhereAllResidualsAreSmall) {
  const Scan scan = drive(2, 400, {8.0, 0.2, -0.1}, 0.05);
  Eigen::MatrixX3d U(400, 3);
  Eigen::VectorXd s(400);
  for (Eigen::Index i = 0; i < 400; ++i) {
    U.row(i) = scan.directions()[static_cast<std::size_t>(i)];
    s[i] = scan.doppler()[static_cast<std::size_t>(i)];
  }
  const Vector3d expected = dense::least_squares(U, -s);
  const EgoVelocity ego = estimate(scan);
  EXPECT_LT((ego.velocity_sensor - expected).norm(), 1e-5);
  // Then the covariance is the textbook one, s^2 (U^T U)^-1.
  const double variance = (s + U * expected).squaredNorm() / 397.0;
  const Eigen::Matrix3d covariance = variance * (U.transpose() * U).inverse();
  EXPECT_LT((ego.covariance - covariance).norm(), 1e-4 * covariance.norm());
}

TEST(DopplerRegression, MinimisesTheHuberCost) {
  const Scan scan = drive(3, 600, {15.0, 0.0, 0.0}, 0.1, 200);
  const EgoVelocity ego = estimate(scan);
  const double minimum = huber_cost(scan, ego.velocity_sensor, 0.3);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double step : {-1e-2, 1e-2}) {
      EXPECT_GT(huber_cost(scan, ego.velocity_sensor + step * Vector3d::Unit(axis), 0.3), minimum);
    }
  }
}

TEST(DopplerRegression, BearsMovingPoints) {
  const Vector3d v(15.0, 0.5, 0.0);
  const EgoVelocity ego = estimate(drive(4, 3000, v, 0.05, 300));
  EXPECT_LT((ego.velocity_sensor - v).norm(), 0.15);
  EXPECT_GT(ego.inliers, 2600u);
}

TEST(DopplerRegression, CovarianceCoversTheTrueError) {
  // Normalised error squared over many scans: its mean is 3 when the covariance is honest.
  const Vector3d v(10.0, 1.0, 0.0);
  double sum = 0.0;
  constexpr int kScans = 300;
  for (unsigned seed = 0; seed < kScans; ++seed) {
    const EgoVelocity ego =
        estimate(drive(100 + seed, 200, v, 0.2));  // about one residual in seven beyond the threshold
    const Vector3d error = ego.velocity_sensor - v;
    sum += error.dot(ego.covariance.inverse() * error);
  }
  EXPECT_NEAR(sum / kScans, 3.0, 0.6);
}

TEST(DopplerRegression, KeepsThePriorAlongWhatNobodySees) {
  // All lines of sight in the plane z = 0: nothing is known of v_z.
  RawScan raw;
  for (int i = 0; i < 50; ++i) {
    const Vector3d u(std::cos(0.02 * i), std::sin(0.02 * i), 0.0);
    raw.points.push_back(10.0 * u);
    raw.doppler.push_back(-u.dot(Vector3d(5.0, 1.0, 0.0)));
  }
  const EgoVelocity ego = estimate(Scan::from_raw(raw), {0.0, 0.0, 0.7});
  EXPECT_EQ(ego.status, EgoVelocityStatus::kDegenerate);
  EXPECT_LT((ego.velocity_sensor - Vector3d(5.0, 1.0, 0.7)).norm(), 1e-6);
  EXPECT_NEAR(ego.unobservable(2, 2), 1.0, 1e-9);
}

TEST(DopplerRegression, TooFewPointsGiveThePriorAndSaySo) {
  for (const std::size_t n : {0u, 1u, 2u}) {
    const EgoVelocity ego = estimate(drive(5, n, {5.0, 0.0, 0.0}, 0.0), {4.0, 0.0, 0.0});
    EXPECT_EQ(ego.status, EgoVelocityStatus::kTooFewPoints);
    EXPECT_EQ(ego.velocity_sensor, Vector3d(4.0, 0.0, 0.0));
  }
  EXPECT_EQ(EgoVelocity{}.status, EgoVelocityStatus::kNotRun);
}

// Lines of sight half a thousandth apart determine nothing across them, and the Doppler contradicts itself.
TEST(DopplerRegression, AVelocityBeyondAnyVehicleIsNotObserved) {
  RawScan raw;
  for (int i = 0; i < 100; ++i) {
    raw.points.emplace_back(100.0, 0.05 * (i % 2), 0.05 * (i / 2 % 2));
    raw.doppler.push_back(i % 2 == 0 ? 10.0 : -10.0);
  }
  DopplerRegressionConfig config;
  config.huber_delta_mps = 100.0;
  const Eigen::Vector3d prior(1.0, 2.0, 3.0);
  const EgoVelocity ego = estimate_velocity(Scan::from_raw(raw), prior, config, Workers(1));
  EXPECT_EQ(ego.status, EgoVelocityStatus::kDegenerate);
  EXPECT_EQ(ego.velocity_sensor, prior);
  EXPECT_TRUE(ego.unobservable.isIdentity());
}

TEST(DopplerRegression, NoDopplerAtAllMeansStandingStill) {
  RawScan raw;
  for (const Vector3d& point : {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1), Vector3d(1, 1, 1)}) {
    raw.points.push_back(point);
    raw.doppler.push_back(0.0);
  }
  const EgoVelocity ego = estimate(Scan::from_raw(raw));
  EXPECT_EQ(ego.status, EgoVelocityStatus::kConverged);
  EXPECT_EQ(ego.velocity_sensor, Vector3d::Zero());
}

TEST(DopplerRegression, TurnsWithTheScan) {
  const Scan scan = drive(6, 800, {9.0, 0.0, 0.5}, 0.05, 100);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  RawScan turned;
  for (const Vector3d& point : scan.points()) {
    turned.points.push_back(R * point);
  }
  turned.doppler = scan.doppler();
  EXPECT_LT((estimate(Scan::from_raw(turned)).velocity_sensor - R * estimate(scan).velocity_sensor).norm(), 1e-4);
}

TEST(DopplerRegression, SameBitsForAnyNumberOfThreads) {
  const Scan scan = drive(7, 20'000, {11.0, -0.3, 0.1}, 0.1, 4000);
  const EgoVelocity one = estimate(scan, Vector3d::Zero(), 1);
  for (const int threads : {2, 7}) {
    EXPECT_EQ(estimate(scan, Vector3d::Zero(), threads).velocity_sensor, one.velocity_sensor);
    EXPECT_EQ(estimate(scan, Vector3d::Zero(), threads).covariance, one.covariance);
  }
}

}  // namespace
}  // namespace dynamic_icp::ego_motion
