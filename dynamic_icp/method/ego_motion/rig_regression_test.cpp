// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/rig_regression.hpp"

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "testing/dense_algebra.hpp"

namespace dynamic_icp::ego_motion {
namespace {

/// The motion of a rig, and where its sensors are and look (yaw, rad).
struct Rig {
  Eigen::Vector3d velocity{8.0, 0.3, -0.1};
  Eigen::Vector3d acceleration{0.5, -1.0, 0.2};
  Eigen::Vector3d omega{0.02, -0.03, 0.5};
  Eigen::Vector3d alpha{0.1, -0.1, 0.3};
  std::vector<Eigen::Vector3d> lever_arms = {{1.5, 0.2, 2.0}, {0.7, -0.7, 1.9}, {0.7, 0.6, 1.9}, {-0.9, 0.0, 2.2}};
  std::vector<double> yaws = {0.0, -1.5, 1.5, 3.1};
  std::vector<double> bias_mps = {0.1, -0.05, 0.02, -0.12};
  double noise_mps = 0.05;
  double sweep_s = 0.1;
};

/// The equation at the head of rig_regression.hpp, point by point; one in ten points moves.
RawScan rig_scan_of(const Rig& rig, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::normal_distribution<double> normal(0.0, 1.0);
  RawScan raw;
  for (std::size_t k = 0; k < rig.lever_arms.size(); ++k) {
    raw.mountings.push_back(Eigen::Isometry3d(Eigen::Translation3d(rig.lever_arms[k])));
    for (int i = 0; i < 1500; ++i) {
      const double azimuth = rig.yaws[k] + uniform(random);
      const Eigen::Vector3d u(std::cos(azimuth), std::sin(azimuth), 0.25 * uniform(random));
      const Eigen::Vector3d point = rig.lever_arms[k] + (20.0 + 15.0 * uniform(random)) * u.normalized();
      const double time = rig.sweep_s * 0.5 * (1.0 + uniform(random));
      const double dt = time - 0.5 * rig.sweep_s;
      const Eigen::Vector3d velocity =
          rig.velocity + dt * rig.acceleration + (rig.omega + dt * rig.alpha).cross(rig.lever_arms[k]);
      const bool moves = i % 10 == 0;
      raw.points.push_back(point);
      raw.doppler.push_back(-u.normalized().dot(velocity) + rig.bias_mps[k] + rig.noise_mps * normal(random) +
                            (moves ? 5.0 * uniform(random) : 0.0));
      raw.times.push_back(time);
      raw.channels.sensor.push_back(static_cast<std::uint8_t>(k));
    }
  }
  raw.times.front() = 0.0;
  raw.times.back() = rig.sweep_s;
  return raw;
}

RigDoppler truth_of(const Rig& rig) {
  RigDoppler truth;
  truth.omega = rig.omega;
  truth.alpha = rig.alpha;
  truth.reference_time_s = 0.5 * rig.sweep_s;
  truth.bias_mps =
      Eigen::Map<const Eigen::VectorXd>(rig.bias_mps.data(), static_cast<Eigen::Index>(rig.bias_mps.size()));
  return truth;
}

/// What is known of the rotation of a vehicle without looking: nothing of omega, the size of alpha.
AngularMotion unknown_rotation() {
  AngularMotion motion;
  motion.covariance.topLeftCorner<3, 3>() *= 1.0;
  motion.covariance.bottomRightCorner<3, 3>() *= 0.25;
  return motion;
}

RigEstimate estimate(const Rig& rig, std::uint32_t seed) {
  Scan scan = Scan::from_raw(rig_scan_of(rig, seed));
  RigDoppler reduced = truth_of(rig);
  reduced.bias_mps.setZero();
  reduced.alpha.setZero();
  reduced.omega = rig_angular_velocity(scan, {}, {}, Workers(1)).omega;
  reduce_to_origin(scan, reduced, Workers(1));
  const RigPrior prior = first_rig_prior({}, rig.lever_arms.size());
  const EgoVelocity start = estimate_velocity(scan, as_ego_prior(prior), {}, Workers(1));
  return estimate_rig_motion(scan, reduced, start, prior, unknown_rotation(), {}, {}, Workers(1));
}

TEST(ReduceToOrigin, LeavesTheDopplerOfTheOrigin) {
  Rig rig;
  rig.noise_mps = 0.0;
  Scan scan = Scan::from_raw(rig_scan_of(rig, 1));
  const std::vector<double> measured = scan.doppler();
  reduce_to_origin(scan, truth_of(rig), Workers(2));
  for (std::size_t i = 1; i < scan.size(); i += 10) {  // those at 0, 10, .. move
    const Eigen::Vector3d velocity = rig.velocity + (scan.times()[i] - 0.05) * rig.acceleration;
    if (i + 1 < scan.size()) {
      ASSERT_NEAR(scan.doppler()[i], -scan.directions()[i].dot(velocity), 1e-9) << i;
    }
  }
  reduce_to_origin(scan, truth_of(rig), Workers(2), -1.0);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    ASSERT_NEAR(scan.doppler()[i], measured[i], 1e-12);
  }
}

TEST(RigAngularVelocity, IsFoundWithoutAnyPrior) {
  const Scan scan = Scan::from_raw(rig_scan_of(Rig{}, 2));
  EXPECT_LT((rig_angular_velocity(scan, {}, {}, Workers(1)).omega - Rig{}.omega).norm(), 0.1);
}

TEST(RigRegression, ErrorsAreAsLargeAsStated) {
  double nees_velocity = 0.0;
  double nees_omega = 0.0;
  double nees_rotation = 0.0;
  constexpr int kScans = 40;
  for (std::uint32_t seed = 0; seed < kScans; ++seed) {
    const Rig rig;
    const RigEstimate found = estimate(rig, seed);
    ASSERT_TRUE(found.ego.rotation.has_value());
    const Eigen::Vector3d velocity_error = found.filtered.mean.head<3>() - rig.velocity;
    nees_velocity +=
        dense::normalised_squared(velocity_error, found.filtered.covariance.topLeftCorner<3, 3>()) / kScans;
    const Eigen::Vector3d omega_error = found.ego.rotation->omega - rig.omega;
    nees_omega += dense::normalised_squared(omega_error, found.ego.rotation->covariance) / kScans;
    // As information on [omega; alpha], with the truth instead of any prior: the expected value of x' I x is 6.
    Vector6d error;
    error << rig.omega, rig.alpha;
    error -= found.rotation.at;
    const Vector6d pull = found.rotation.weighted_change - found.rotation.information * error;
    nees_rotation += dense::normalised_squared(pull, found.rotation.information) / kScans;
    EXPECT_LT(omega_error.norm(), 0.05) << seed;
  }
  // Mean of chi^2 with 3 degrees of freedom over 40 scans: 3 +- 0.4; the biases are unknown, floors widen a little.
  EXPECT_GT(nees_velocity, 1.2);
  EXPECT_LT(nees_velocity, 4.5);
  EXPECT_GT(nees_omega, 1.2);
  EXPECT_LT(nees_omega, 4.5);
  EXPECT_GT(nees_rotation, 2.5);
  EXPECT_LT(nees_rotation, 9.0);
}

TEST(RigRegression, LearnsTheErrorOfEachSensor) {
  const Rig rig;
  const RigEstimate found = estimate(rig, 7);
  for (std::size_t k = 0; k < rig.bias_mps.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(6 + k);
    const double sigma = std::sqrt(found.filtered.covariance(row, row));
    EXPECT_LT(std::abs(found.filtered.mean[row] - rig.bias_mps[k]), 4.0 * sigma) << k;
    EXPECT_LT(sigma, 0.05) << "half of the field of view is enough to see it";
  }
}

TEST(RigRegression, TheLineThroughTwoSensorsLeavesItsRotationOpen) {
  Rig rig;
  rig.lever_arms = {{1.5, 0.6, 2.0}, {1.5, -0.6, 2.0}};
  rig.yaws = {0.3, -0.3};
  rig.bias_mps = {0.0, 0.0};
  const RigEstimate found = estimate(rig, 3);
  ASSERT_TRUE(found.ego.rotation.has_value());
  const Eigen::Matrix3d& covariance = found.ego.rotation->covariance;
  EXPECT_GT(covariance(1, 1), 25.0) << "(rad/s)^2: nothing is known";
  EXPECT_LT(std::sqrt(covariance(2, 2)), 0.3) << "the yaw rate is";
  EXPECT_LT((found.ego.velocity_sensor - rig.velocity).norm(), 6.0) << "coupled with that rotation";
}

TEST(RigRegression, WithoutAVelocityNothingIsLearned) {
  const Scan scan = Scan::from_raw(rig_scan_of(Rig{}, 4));
  EgoVelocity start;
  start.status = EgoVelocityStatus::kAmbiguous;
  const RigPrior prior = first_rig_prior({}, 4);
  const RigEstimate found =
      estimate_rig_motion(scan, truth_of(Rig{}), start, prior, unknown_rotation(), {}, {}, Workers(1));
  EXPECT_TRUE(found.rotation.information.isZero(0.0));
  EXPECT_FALSE(found.ego.rotation.has_value());
  EXPECT_EQ(found.filtered.mean, prior.mean);
}

}  // namespace
}  // namespace dynamic_icp::ego_motion
