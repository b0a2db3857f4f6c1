// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/velocity_modes.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace dynamic_icp::ego_motion {
namespace {

using Eigen::Vector3d;

/// Points all around; the first `share` of them see the sensor move with `a`, the others with `b`.
ConsensusSet two_groups(double share, const Vector3d& a, const Vector3d& b, double noise_mps) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::normal_distribution<double> normal;
  RawScan raw;
  for (int i = 0; i < 1000; ++i) {
    const Vector3d point = 40.0 * Vector3d(uniform(random), uniform(random), uniform(random));
    raw.points.push_back(point);
    raw.doppler.push_back(-point.normalized().dot(i < 1000.0 * share ? a : b) + noise_mps * normal(random));
  }
  return sample(sort_into_cells(Scan::from_raw(raw), 0.5, Workers(1)), 1000);
}

Vector7d state(const Vector3d& v) {
  Vector7d x = Vector7d::Zero();
  x.head<3>() = v;
  return x;
}

TEST(VelocityModes, FindBothVelocitiesTheStrongerFirst) {
  const Vector3d a(8.0, 1.0, 0.0);
  const Vector3d b(-3.0, 0.0, 1.0);
  const ConsensusSet consensus_set = two_groups(0.6, a, b, 0.02);
  const std::vector<VelocityMode> modes = find_modes(consensus_set, Vector7d::Zero(), {}, Workers(1));
  ASSERT_GE(modes.size(), 2u);
  EXPECT_LT((modes[0].x.head<3>() - a).norm(), 0.2);
  EXPECT_LT((modes[1].x.head<3>() - b).norm(), 0.2);
  EXPECT_GT(modes[0].inlier_weight, modes[1].inlier_weight);
}

TEST(VelocityModes, AreAtLeastTheStart) {
  EXPECT_EQ(find_modes(ConsensusSet{}, state({1, 2, 3}), {}, Workers(1)).size(), 1u);
  EXPECT_EQ(find_modes(ConsensusSet{}, state({1, 2, 3}), {}, Workers(1))[0].x, state({1, 2, 3}));
}

TEST(VelocityModes, DifferByMoreThanTheWidth) {
  const ConsensusSet consensus_set = two_groups(0.5, {5, 0, 0}, {4, 0, 0}, 0.3);
  const ModeSearch search;
  const std::vector<VelocityMode> modes = find_modes(consensus_set, Vector7d::Zero(), search, Workers(1));
  ASSERT_GE(modes.size(), 2u);
  for (std::size_t i = 0; i < modes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT(StateDistance(consensus_set.rows)(modes[i].x, modes[j].x), search.width_mps);
    }
  }
}

TEST(VelocityModes, AreTheSameForAnyNumberOfThreads) {
  const ConsensusSet consensus_set = two_groups(0.4, {8, 1, 0}, {2, 0, 0}, 0.1);
  const std::vector<VelocityMode> one = find_modes(consensus_set, Vector7d::Zero(), {}, Workers(1));
  const std::vector<VelocityMode> many = find_modes(consensus_set, Vector7d::Zero(), {}, Workers(5));
  ASSERT_EQ(one.size(), many.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].x, many[k].x);
    EXPECT_EQ(one[k].inlier_weight, many[k].inlier_weight);
  }
}

TEST(Votes, AreTheWeightOfTheRowsThatAgree) {
  const ConsensusSet consensus_set = two_groups(1.0, {5, 0, 0}, {5, 0, 0}, 0.0);
  EXPECT_NEAR(inlier_weight(consensus_set, state({5, 0, 0}), 0.1), 1.0, 1e-9);
  EXPECT_LT(inlier_weight(consensus_set, state({-5, 0, 0}), 0.1), 0.02);
  // One row: 1 - (e/width)^2 with e = 0.05, width = 0.1.
  RawScan raw;
  raw.points.emplace_back(1.0, 0.0, 0.0);
  raw.doppler.push_back(-1.0);
  EXPECT_NEAR(
      inlier_weight(sample(sort_into_cells(Scan::from_raw(raw), 2.0, Workers(1)), 10), state({1.05, 7, 7}), 0.1), 0.75,
      1e-9);
}

TEST(Distance, IsWhatTheSensorWouldSee) {
  RawScan raw;
  raw.points = {{10, 0, 0}, {0, 10, 0}};
  raw.doppler = {0, 0};
  raw.times = {0.0, 0.2};
  const DopplerRows rows = sort_into_cells(Scan::from_raw(raw), 2.0, Workers(1));
  EXPECT_NEAR(StateDistance(rows)(state({3, 4, 0}), Vector7d::Zero()), std::sqrt((9.0 + 16.0) / 2.0), 1e-12);
  EXPECT_NEAR(StateDistance(rows)(state({3, 4, 9}), state({3, 4, -9})), 0.0, 1e-12) << "nobody looks up";
  // 0.1 s from the middle of the scan an acceleration of 10 m/s^2 is 1 m/s.
  Vector7d accelerated = Vector7d::Zero();
  accelerated.segment<3>(3) = Eigen::Vector3d(10.0, 10.0, 0.0);
  EXPECT_NEAR(StateDistance(rows)(accelerated, Vector7d::Zero()), 1.0, 1e-12);
  EXPECT_EQ(StateDistance(DopplerRows{})(state({3, 4, 9}), Vector7d::Zero()), 0.0);
}

}  // namespace
}  // namespace dynamic_icp::ego_motion
