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

TEST(Expectation, OfWhatWasHiddenOtherPartsMayAppear) {
  const Track track = track_of_car({20.0, 5.0, 0.0}, {8.0, 0.0, 0.0});
  BoxEstimate estimate = track.estimate();
  estimate.centre_covariance.diagonal() = Vector3d(0.64, 0.01, 0.01);
  const Expectation seen(track, estimate, SensorMotion{}, {});
  const Expectation hidden(track, estimate, SensorMotion{}, {}, true);
  const auto ratio = [&](const Expectation& expected, double beyond_m) {
    const OrientedBox& box = estimate.box;
    return expected.distance_ratio(box.centre + (0.5 * box.size.x() + beyond_m) * box.axes.col(0), 0.0);
  };
  ASSERT_GT(ratio(seen, 1.5), 1.0);
  EXPECT_LT(ratio(hidden, 1.5), 1.0) << "within twice 0.8 m";
  EXPECT_GT(ratio(hidden, 1.7), 1.0);
}

TEST(Expectation, OnlyWhatCrossesTheLineOfSightMayAppearStatic) {
  const Vector3d eye = Vector3d::Zero();
  EXPECT_TRUE(expectation_of({20.0, 0.0, 0.0}, {0.0, 8.0, 0.0}).may_appear_static(eye, 1.0));
  EXPECT_FALSE(expectation_of({20.0, 0.0, 0.0}, {8.0, 0.0, 0.0}).may_appear_static(eye, 1.0));
}

}  // namespace
}  // namespace dynamic_icp::tracking
