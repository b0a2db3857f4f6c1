// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/rig_doppler.hpp"

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
  Eigen::Vector3d omega{0.02, -0.03, 0.5};
  std::vector<Eigen::Vector3d> lever_arms = {{1.5, 0.2, 2.0}, {0.7, -0.7, 1.9}, {0.7, 0.6, 1.9}, {-0.9, 0.0, 2.2}};
  std::vector<double> yaws = {0.0, -1.5, 1.5, 3.1};
  double noise_mps = 0.05;
};

/// The equation at the head of rig_doppler.hpp, point by point; one in ten points moves.
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
      const Eigen::Vector3d velocity = rig.velocity + rig.omega.cross(rig.lever_arms[k]);
      const bool moves = i % 10 == 0;
      raw.points.push_back(point);
      raw.doppler.push_back(-u.normalized().dot(velocity) + rig.noise_mps * normal(random) +
                            (moves ? 5.0 * uniform(random) : 0.0));
      raw.channels.sensor.push_back(static_cast<std::uint8_t>(k));
    }
  }
  return raw;
}

TEST(TakeOutLeverArms, LeavesTheDopplerOfTheOrigin) {
  Rig rig;
  rig.noise_mps = 0.0;
  Scan scan = Scan::from_raw(rig_scan_of(rig, 1));
  const std::vector<double> measured = scan.doppler();
  take_out_lever_arms(scan, rig.omega, Workers(2));
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (i % 1500 % 10 != 0) {  // the others move
      ASSERT_NEAR(scan.doppler()[i], -scan.directions()[i].dot(rig.velocity), 1e-9) << i;
    }
  }
  take_out_lever_arms(scan, rig.omega, Workers(2), -1.0);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    ASSERT_NEAR(scan.doppler()[i], measured[i], 1e-12);
  }
}

TEST(RigAngularVelocity, ErrorsAreAsLargeAsStated) {
  double nees = 0.0;
  constexpr int kScans = 40;
  for (std::uint32_t seed = 0; seed < kScans; ++seed) {
    const Scan scan = Scan::from_raw(rig_scan_of(Rig{}, seed));
    const AngularVelocity found = rig_angular_velocity(scan, {}, Workers(1));
    const Eigen::Vector3d error = found.omega - Rig{}.omega;
    EXPECT_LT(error.norm(), 0.1) << seed;
    nees += dense::normalised_squared(error, found.covariance) / kScans;
  }
  // Mean of chi^2 with 3 degrees of freedom over 40 scans: 3 +- 0.4; errors of the sensors that might be there widen.
  EXPECT_LT(nees, 4.5);
  EXPECT_GT(nees, 0.1);
}

TEST(RigAngularVelocity, TheLineThroughTwoSensorsLeavesItsRotationOpen) {
  Rig rig;
  rig.lever_arms = {{1.5, 0.6, 2.0}, {1.5, -0.6, 2.0}};
  rig.yaws = {0.3, -0.3};
  const AngularVelocity found = rig_angular_velocity(Scan::from_raw(rig_scan_of(rig, 3)), {}, Workers(1));
  EXPECT_NEAR(std::sqrt(found.covariance(1, 1)), 0.5, 0.01) << "rad/s, what a vehicle may have at its first scan";
  EXPECT_LT(std::sqrt(found.covariance(2, 2)), 0.4) << "the yaw rate shows";
}

}  // namespace
}  // namespace dynamic_icp::ego_motion
