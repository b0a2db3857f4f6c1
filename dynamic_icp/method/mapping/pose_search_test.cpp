// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/mapping/pose_search.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/se3.hpp"

#include "testing/one_thread.hpp"

namespace dynamic_icp::mapping {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

/// Points on the inner faces of a box-shaped hall, or of a tunnel: a hall without its ends.
struct Hall {
  bool has_ends = true;

  [[nodiscard]] std::vector<Vector3d> points(unsigned seed, std::size_t count) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::normal_distribution<double> normal(0.0, 0.01);
    std::vector<Vector3d> result;
    while (result.size() < count) {
      const Vector3d half(25.0, 8.3, 3.1);
      Vector3d point = half.cwiseProduct(Vector3d(uniform(random), uniform(random), uniform(random)));
      const int face = static_cast<int>(result.size() % (has_ends ? 6 : 4));
      const int axis = 2 - face / 2;
      point[axis] = (face % 2 == 0 ? 1.0 : -1.0) * half[axis] + normal(random);
      result.push_back(point);
    }
    return result;
  }

  [[nodiscard]] PlaneMap map() const {
    PlaneMap result({});
    result.add(points(1, 40000), Vector3d::Zero(), kOneThread);
    return result;
  }

  /// What a sensor at T_map_sensor measures that moves like `sweep` while it looks around.
  [[nodiscard]] Scan scan(const Eigen::Isometry3d& T_map_sensor, const motion::SweepMotion& sweep = {}) const {
    RawScan raw;
    for (const Vector3d& seen : points(2, 6000)) {
      const double tau = 0.1 * (std::atan2(seen.y(), seen.x()) + pi) / (2.0 * pi);
      raw.points.push_back((T_map_sensor * sweep.pose(tau)).inverse() * seen);
      raw.doppler.push_back(0.0);
      raw.times.push_back(tau);
    }
    return Scan::from_raw(raw);
  }
};

Eigen::Isometry3d pose(const Vector3d& rotation, const Vector3d& translation) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = exp_so3(rotation);
  T.translation() = translation;
  return T;
}

PosePrior prior_around(const Eigen::Isometry3d& truth, const Vector3d& rotation_off, const Vector3d& position_off) {
  PosePrior prior;
  prior.R_map_sensor = exp_so3(rotation_off) * truth.linear();
  prior.rotation_sigma_rad = 0.1;
  prior.displacement_fixed = truth.translation() + position_off;
  prior.position_sigma_m = 0.2;
  return prior;
}

double rotation_error(const FoundPose& found, const Eigen::Isometry3d& truth) {
  return rotation_angle(found.T_map_sensor.linear().transpose() * truth.linear());
}

double position_error(const FoundPose& found, const Eigen::Isometry3d& truth) {
  return (found.T_map_sensor.translation() - truth.translation()).norm();
}

TEST(SearchPose, FindsRotationsAboutAllAxes) {
  const Hall hall;
  const PlaneMap map = hall.map();
  const Eigen::Isometry3d truth = pose({0.02, -0.03, 0.3}, {2.0, -1.0, 0.4});
  const Scan scan = hall.scan(truth);
  for (const Vector3d& off : {Vector3d(0.0, 0.0, 0.2), Vector3d(0.0, -0.15, 0.0), Vector3d(0.15, 0.0, 0.0)}) {
    const FoundPose found = search_pose(scan, map, prior_around(truth, off, {0.1, 0.1, -0.1}), kOneThread);
    EXPECT_LT(rotation_error(found, truth), 3e-4) << off.transpose();
    EXPECT_LT(position_error(found, truth), 3e-3) << off.transpose();
    EXPECT_GT(found.matched, 0.8 * 6000.0) << off.transpose();
  }
}

TEST(SearchPose, TurnsTheDisplacementWithTheScan) {
  // The prior is turned by 0.1 rad, and so is the displacement it expects; in a tunnel only the rotation found can mend
  // it.
  const Hall tunnel{.has_ends = false};
  const Eigen::Isometry3d truth = pose({0.0, 0.0, 0.05}, {2.0, 0.0, 0.0});
  PosePrior prior = prior_around(truth, {0.0, 0.0, 0.1}, Vector3d::Zero());
  prior.displacement_fixed.setZero();
  prior.displacement_rotated = truth.linear().transpose() * truth.translation();
  prior.position_sigma_m = 1e-3;
  EXPECT_LT(position_error(search_pose(tunnel.scan(truth), tunnel.map(), prior, kOneThread), truth), 1e-3);
}

TEST(SearchPose, DeskewsByTheGivenMotion) {
  const Hall hall;
  motion::SweepMotion sweep;
  sweep.omega = {0.05, -0.1, 0.5};
  sweep.velocity = {15.0, 0.3, -0.1};
  const Eigen::Isometry3d truth = pose({0.01, 0.0, 0.1}, {-3.0, 0.5, 0.2});
  PosePrior prior = prior_around(truth, {0.01, 0.01, 0.01}, {0.05, 0.05, 0.0});
  prior.sweep = sweep;
  const FoundPose found = search_pose(hall.scan(truth, sweep), hall.map(), prior, kOneThread);
  EXPECT_LT(rotation_error(found, truth), 5e-4);
  EXPECT_LT(position_error(found, truth), 5e-3);
}

TEST(SearchPose, WithoutAMapKeepsThePrior) {
  const Eigen::Isometry3d truth = pose({0.0, 0.0, 0.1}, {1.0, 0.0, 0.0});
  const PosePrior prior = prior_around(truth, {0.01, 0.0, 0.0}, {0.1, 0.0, 0.0});
  const FoundPose found = search_pose(Hall{}.scan(truth), PlaneMap({}), prior, kOneThread);
  EXPECT_EQ(found.matched, 0.0);
  EXPECT_FALSE(found.diverged);
  EXPECT_LT((found.T_map_sensor.linear() - prior.R_map_sensor).norm(), 1e-12);
  EXPECT_LT((found.T_map_sensor.translation() - prior.displacement_fixed).norm(), 1e-12);
}

TEST(SearchPose, DoesNotDependOnTheThreads) {
  const Hall hall;
  const PlaneMap map = hall.map();
  const Eigen::Isometry3d truth = pose({0.0, 0.0, 0.1}, {1.0, 0.0, 0.0});
  const Scan scan = hall.scan(truth);
  const PosePrior prior = prior_around(truth, {0.01, 0.0, 0.02}, {0.1, 0.0, 0.0});
  const FoundPose one = search_pose(scan, map, prior, kOneThread);
  const FoundPose three = search_pose(scan, map, prior, Workers(3));
  EXPECT_EQ(one.T_map_sensor.matrix(), three.T_map_sensor.matrix());
  EXPECT_EQ(one.matched, three.matched);
}

}  // namespace
}  // namespace dynamic_icp::mapping
