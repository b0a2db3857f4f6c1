// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/articulation.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

constexpr double kNoise_mps = 0.05;
constexpr double kJointAt_m = 1.0;  // ahead of the middle

/// A side, 2.5 m high, of a lorry that drives along x, seen from the origin. Its parts are joined at kJointAt_m ahead
/// of its middle and turn with rates of their own.
struct Lorry {
  double length_m = 12.0;
  double rate_ahead_rps = 0.3;
  double rate_behind_rps = 0.3;
  double outliers = 0.0;
  double changing_mps = 0.0;  ///< an error of the Doppler that is so large in the middle and at the ends
  std::uint64_t seed = 1;
};

Detection seen(const Lorry& lorry) {
  const Vector3d middle(18.0, 8.0, 0.5);
  const Vector3d joint = middle + Vector3d(kJointAt_m, 0.0, 0.0);
  Detection detection;
  for (std::uint64_t i = 0; i < 400; ++i) {
    const RandomSource one = RandomSource(lorry.seed).fork(i);
    const double along = one.uniform(0, -0.5, 0.5) * lorry.length_m;
    const Vector3d point = middle + Vector3d(along, 0.0, one.uniform(1, -1.2, 1.3));
    const double rate = along > kJointAt_m ? lorry.rate_ahead_rps : lorry.rate_behind_rps;
    const Vector3d velocity = Vector3d(6.0, 0.5, 0.0) + rate * Vector3d::UnitZ().cross(point - joint);
    const double error = lorry.changing_mps * std::cos(4.0 * std::numbers::pi * along / lorry.length_m);
    const bool is_gross = one.uniform(2) < lorry.outliers;
    detection.points.push_back(point);
    detection.directions.push_back(point.normalized());
    detection.radial.push_back(is_gross
                                   ? one.uniform(3, -20.0, 20.0)
                                   : detection.directions.back().dot(velocity) + error + kNoise_mps * one.normal(4));
    detection.times.push_back(0.0);
  }
  return detection;
}

std::optional<Joint> joint_of(const Lorry& lorry) {
  return find_joint(seen(lorry), Eigen::Matrix3d::Identity(), 0.0, kNoise_mps);
}

TEST(Articulation, ARigidBodyHasNoJointHoweverItTurns) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    for (const double rate : {-0.5, 0.0, 0.3}) {
      const Lorry lorry = {.rate_ahead_rps = rate, .rate_behind_rps = rate, .outliers = 0.1, .seed = seed};
      EXPECT_FALSE(joint_of(lorry)) << "seed " << seed << " rate " << rate;
    }
  }
}

TEST(Articulation, ErrorsOfTheDopplerThatChangeOverABodyAreNoJoint) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_FALSE(joint_of({.changing_mps = 0.03, .seed = seed})) << seed;
  }
}

TEST(Articulation, PartsThatTurnDifferentlyMeetAtTheJoint) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const double outliers : {0.0, 0.1}) {
      const std::optional<Joint> joint = joint_of({.rate_behind_rps = 0.0, .outliers = outliers, .seed = seed});
      ASSERT_TRUE(joint) << seed;
      EXPECT_NEAR(joint->place_m, 18.0 + kJointAt_m, 1.0) << seed;
    }
  }
}

/// A side 8 m away and another one 3 m farther, of bodies that drive along x with these speeds.
Detection abreast(double near_mps, double far_mps) {
  Detection detection;
  for (std::uint64_t i = 0; i < 300; ++i) {
    const RandomSource one = RandomSource(3).fork(i);
    const bool is_far = i % 3 == 0;
    const Vector3d point(12.0 + (is_far ? one.uniform(0, -1.0, 3.0) : one.uniform(0, -3.0, 3.0)), is_far ? 11.0 : 8.0,
                         one.uniform(1, -1.0, 1.0));
    detection.points.push_back(point);
    detection.directions.push_back(point.normalized());
    detection.radial.push_back((is_far ? far_mps : near_mps) * point.normalized().x() + kNoise_mps * one.normal(2));
    detection.times.push_back(0.0);
  }
  return detection;
}

TEST(Articulation, BodiesAbreastMeetBetweenThemIfTheirSpeedsDiffer) {
  const Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  EXPECT_FALSE(find_joint(abreast(2.0, 2.0), axes, 0.0, kNoise_mps));
  const std::optional<Joint> joint = find_joint(abreast(2.0, 2.8), axes, 0.0, kNoise_mps);
  ASSERT_TRUE(joint);
  EXPECT_TRUE(joint->is_across);
  EXPECT_GT(joint->place_m, 8.0);
  EXPECT_LT(joint->place_m, 11.0);
}

TEST(Articulation, WhatIsAsShortAsACarHasNoJoint) {
  EXPECT_FALSE(joint_of({.length_m = 4.6, .rate_ahead_rps = 1.5, .rate_behind_rps = -1.5}));
}

}  // namespace
}  // namespace dynamic_icp::tracking
