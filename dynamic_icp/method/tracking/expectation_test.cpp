// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/expectation.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

/// A track of a car that drives with `velocity`, from its rear and right side.
Track track_of_car(const Vector3d& centre, const Vector3d& velocity) {
  const Eigen::Matrix3d axes = upright_axes(std::atan2(velocity.y(), velocity.x()));
  Detection detection;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const RandomSource one = RandomSource(4).fork(i);
    Vector3d q(one.uniform(0, -0.5, 0.5), one.uniform(1, -0.5, 0.5), one.uniform(2, -0.5, 0.5));
    (i % 3 == 0 ? q.x() : q.y()) = -0.5;
    detection.points.emplace_back(centre + axes * q.cwiseProduct(Vector3d(4.5, 1.8, 1.5)));
    detection.directions.push_back(detection.points.back().normalized());
    detection.radial.push_back(detection.directions.back().dot(velocity));
    detection.times.push_back(0.0);
  }
  return {detection, 0.0, {}};
}

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

TEST(Expectation, VisitsTheStaticPointsInItsBoxAboveTheGround) {
  const Vector3d centre(20.0, 3.0, 0.0);
  const Expectation expected = expectation_of(centre, {0.0, 8.0, 0.0});
  ASSERT_GT(expected.box.size.z(), 1.0);
  RawScan raw;
  std::set<std::uint32_t> inside;
  std::vector<std::uint8_t> is_moving;
  const RandomSource random(9);
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const RandomSource one = random.fork(i);
    const Vector3d p = centre + Vector3d(one.uniform(0, -5, 5), one.uniform(1, -5, 5), one.uniform(2, -1.5, 1.5));
    raw.points.push_back(p);
    raw.doppler.push_back(0.0);
    is_moving.push_back(one.uniform(3) < 0.3 ? 1 : 0);
    const Vector3d q = expected.box.axes.transpose() * (p - expected.box.centre);
    const double above = q.z() + 0.5 * expected.box.size.z();
    const bool in_box = (q.cwiseAbs().array() <= 0.5 * expected.box.size.array()).all();
    if (in_box && above >= std::min(0.3, 0.25 * expected.box.size.z()) && is_moving.back() == 0) {
      inside.insert(i);
    }
  }
  ASSERT_GT(inside.size(), 20u);
  const Scan scan = Scan::from_raw(raw);
  ASSERT_EQ(scan.size(), raw.points.size());
  const std::vector<double> radial(scan.size(), 0.0);
  for (const int threads : {1, 2}) {
    const Workers workers(threads);
    const RangeImage view(scan, Vector3d::Zero(), workers);
    const MovingCells moving;
    const GroundHeights heights;
    const TrackingInput input{scan, radial, is_moving, {}, 0.0, 0.0, moving, {}, {}, {}, view, heights};
    std::vector<std::uint32_t> visited{77};
    find_static_rows(input, expected, visited);
    EXPECT_TRUE(std::is_sorted(visited.begin(), visited.end()));
    EXPECT_EQ(std::set<std::uint32_t>(visited.begin(), visited.end()), inside);
    EXPECT_EQ(visited.size(), inside.size()) << "none twice";
  }
}

}  // namespace
}  // namespace dynamic_icp::tracking
