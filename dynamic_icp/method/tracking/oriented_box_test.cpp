// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/oriented_box.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

OrientedBox box_of_car(double yaw) { return {{10, 5, 1}, upright_axes(yaw), {4, 2, 1.5}}; }

/// The two sides of a box that a sensor on the side of its first two axes sees, with noise.
std::vector<Vector3d> two_sides(const OrientedBox& box, double sigma) {
  const RandomSource random(3);
  std::vector<Vector3d> points;
  for (std::uint64_t i = 0; i < 300; ++i) {
    const RandomSource one = random.fork(i);
    Vector3d q(one.uniform(0, -0.5, 0.5), one.uniform(1, -0.5, 0.5), one.uniform(2, -0.5, 0.5));
    (i % 3 == 0 ? q.x() : q.y()) = 0.5;
    q = q.cwiseProduct(box.size) + sigma * Vector3d(one.normal(3), one.normal(4), 0.0);
    points.emplace_back(box.centre + box.axes * q);
  }
  return points;
}

TEST(OrientedBox, DistanceOutsideIsThatToFaceEdgeAndCorner) {
  const OrientedBox box = box_of_car(0.7);
  EXPECT_EQ(distance_outside(box, box.centre), 0.0);
  EXPECT_NEAR(distance_outside(box, box.centre + 3.0 * box.axes.col(0)), 1.0, 1e-12);
  EXPECT_NEAR(distance_outside(box, box.centre + box.axes * Vector3d(5, 5, 0)), 5.0, 1e-12) << "3 and 4 beyond";
  EXPECT_NEAR(distance_outside(box, box.centre - box.axes * Vector3d(3, 3, 2.75)), 3.0, 1e-12) << "1, 2 and 2 beyond";
}

TEST(OrientedBox, AlignedExtentIsThatOfTheCorners) {
  const OrientedBox box = box_of_car(2.1);
  Vector3d largest = Vector3d::Zero();
  for (const double x : {-2.0, 2.0}) {
    for (const double y : {-1.0, 1.0}) {
      largest = largest.cwiseMax(box.axes * Vector3d(x, y, 0.75));
    }
  }
  EXPECT_TRUE(aligned_extent(box).isApprox(2.0 * largest, 1e-12));
}

TEST(OrientedBox, SpanLeavesOutTheOutermostShare) {
  std::vector<Vector3d> points;
  for (int i = 0; i <= 100; ++i) {
    points.emplace_back(0.0, 2.0 + i, 0.0);
  }
  points[3].y() = 1e6;
  const Interval all = span_along(points, {0, 2, 0}, Vector3d::UnitY(), 0.0);
  EXPECT_EQ(all.low, 0.0);
  EXPECT_EQ(all.high, 1e6 - 2.0);
  const Interval trimmed = span_along(points, {0, 2, 0}, Vector3d::UnitY(), 0.02);
  EXPECT_EQ(trimmed.low, 2.0);
  EXPECT_EQ(trimmed.high, 99.0);
}

TEST(OrientedBox, NothingAndOnePointHaveNoSpan) {
  EXPECT_EQ(span_along({}, Vector3d::Zero(), Vector3d::UnitX(), 0.02).length(), 0.0);
  const std::vector<Vector3d> one = {{3, 0, 0}};
  EXPECT_EQ(span_along(one, Vector3d::Zero(), Vector3d::UnitX(), 0.02).low, 3.0);
  EXPECT_EQ(span_along(one, Vector3d::Zero(), Vector3d::UnitX(), 0.02).high, 3.0);
}

TEST(OrientedBox, FitsTheYawOfTwoSides) {
  for (const double yaw : {-1.3, -0.4, 0.0, 0.5, 1.1, 2.9}) {
    const std::vector<Vector3d> points = two_sides(box_of_car(yaw), 0.02);
    const std::optional<double> fitted = fit_yaw(points, yaw + 0.3, 0.785);
    ASSERT_TRUE(fitted);
    EXPECT_NEAR(std::remainder(*fitted - yaw, 0.5 * std::numbers::pi), 0.0, 0.02) << "yaw " << yaw;
  }
}

TEST(OrientedBox, TooFewPointsHaveNoYaw) {
  EXPECT_FALSE(fit_yaw({}, 0.0, 0.5));
  EXPECT_FALSE(fit_yaw(std::vector<Vector3d>(4, Vector3d::UnitX()), 0.0, 0.5));
  EXPECT_TRUE(std::isfinite(fit_yaw(std::vector<Vector3d>(9, Vector3d::UnitX()), 0.0, 0.5).value()));
}

}  // namespace
}  // namespace dynamic_icp::tracking
