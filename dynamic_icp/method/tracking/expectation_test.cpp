// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/expectation.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "testing/tracked_car.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

Expectation expectation_of(const Vector3d& centre, const Vector3d& velocity) {
  const Track track = track_of_car(centre, velocity);
  return {track, track.estimate(), SensorMotion{}, {}};
}

TEST(Expectation, ItsOwnPointsAreInsideAndHaveItsRadialVelocity) {
  const Vector3d centre(20.0, 5.0, 0.0);
  const Vector3d velocity(8.0, 0.0, 0.0);
  const Expectation expected = expectation_of(centre, velocity);
  const Vector3d rear = centre - Vector3d(2.2, 0.0, 0.0);
  EXPECT_LT(expected.outside(rear, 0.0), 0.1);
  EXPECT_LT(expected.outside(rear + 0.1 * expected.velocity, 0.1), 0.1) << "it has moved on when it was measured";
  EXPECT_GT(expected.outside(rear - Vector3d(6.0, 0.0, 0.0), 0.0), expected.gate_m);
  const Vector3d sight = rear.normalized();
  EXPECT_LT(expected.gate_ratio(sight, sight.dot(velocity)), 0.2);
  EXPECT_GT(expected.gate_ratio(sight, sight.dot(velocity) + 4.0), 1.0) << "beyond the widest gate";
  EXPECT_NEAR(expected.gate_ratio(sight, sight.dot(expected.W) + 1.0),
              expected.gate_ratio(sight, sight.dot(expected.W) - 1.0), 1e-9);
}

TEST(Expectation, OnlyWhatCrossesTheLineOfSightMayAppearStatic) {
  const Vector3d eye = Vector3d::Zero();
  EXPECT_TRUE(expectation_of({20.0, 0.0, 0.0}, {0.0, 8.0, 0.0}).may_appear_static(eye, 1.0));
  EXPECT_FALSE(expectation_of({20.0, 0.0, 0.0}, {8.0, 0.0, 0.0}).may_appear_static(eye, 1.0));
}

}  // namespace
}  // namespace dynamic_icp::tracking
