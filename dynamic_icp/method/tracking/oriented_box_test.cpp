// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/oriented_box.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Matrix3d;
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

TEST(OrientedBox, SpansAreThoseOfSortedValuesInWhateverOrderTheyCome) {
  for (const std::size_t n : {1u, 2u, 7u, 16u, 17u, 90u, 500u, 2000u}) {
    std::vector<double> ascending;
    for (std::uint64_t i = 0; i < n; ++i) {
      ascending.push_back(std::round(20.0 * RandomSource(3).fork(i).normal(0)) / 20.0);  // some are equal
    }
    const std::vector<double> unordered = ascending;
    std::ranges::sort(ascending);
    const std::vector<double> descending(ascending.rbegin(), ascending.rend());
    for (const double trim : {0.0, 0.01, 0.1, 0.45}) {
      const auto rank = static_cast<std::size_t>(trim * static_cast<double>(n - 1));
      for (const std::vector<double>& values : {ascending, unordered, descending}) {
        const Interval span = span_of(values, trim);
        EXPECT_EQ(span.low, ascending[rank]) << rank << " of " << n;
        EXPECT_EQ(span.high, ascending[n - 1 - rank]) << rank << " of " << n;
      }
    }
  }
}

TEST(OrientedBox, NothingAndOnePointHaveNoSpan) {
  EXPECT_EQ(span_along({}, Vector3d::Zero(), Vector3d::UnitX(), 0.02).length(), 0.0);
  const std::vector<Vector3d> one = {{3, 0, 0}};
  EXPECT_EQ(span_along(one, Vector3d::Zero(), Vector3d::UnitX(), 0.02).low, 3.0);
  EXPECT_EQ(span_along(one, Vector3d::Zero(), Vector3d::UnitX(), 0.02).high, 3.0);
}

TEST(OrientedBox, FitsTheYawOfTwoSides) {
  // On level ground and on a slope, in whose axes the yaw counts.
  for (const Matrix3d& level : {Matrix3d(Matrix3d::Identity()), exp_so3({0.1, -0.2, 0.4})}) {
    for (const double yaw : {-1.3, -0.4, 0.0, 0.5, 1.1, 2.9}) {
      OrientedBox box = box_of_car(yaw);
      box.axes = level * box.axes;
      const std::vector<Vector3d> points = two_sides(box, 0.02);
      const std::optional<double> fitted = fit_yaw(points, level, yaw + 0.3, 0.785);
      ASSERT_TRUE(fitted);
      EXPECT_NEAR(std::remainder(*fitted - yaw, 0.5 * std::numbers::pi), 0.0, 0.02) << "yaw " << yaw;
    }
  }
}

/// Points of the grid of `n` + 1 points a side that fills the box, faces included.
std::vector<Vector3d> grid_in(const OrientedBox& box, int n) {
  std::vector<Vector3d> points;
  for (int i = 0; i <= n; ++i) {
    for (int k = 0; k <= n; ++k) {
      for (int m = 0; m <= n; ++m) {
        const Vector3d q = Vector3d(i, k, m) / n - Vector3d::Constant(0.5);
        points.emplace_back(box.centre + box.axes * q.cwiseProduct(box.size));
      }
    }
  }
  return points;
}

/// It stands on the ground, z = 0.
OrientedBox random_box(const RandomSource& random, double spread) {
  const double height = random.uniform(6, 0.5, 3);
  return {{random.uniform(0, -spread, spread), random.uniform(1, -spread, spread), 0.5 * height},
          upright_axes(random.uniform(3, -3, 3)),
          {random.uniform(4, 0.5, 8), random.uniform(5, 0.5, 3), height}};
}

TEST(OrientedBox, DistanceBetweenIsThatOfTheNearestPoints) {
  int apart = 0;
  int overlapping = 0;
  for (std::uint64_t k = 0; k < 60; ++k) {
    const OrientedBox a = random_box(RandomSource(5).fork(2 * k), 6.0);
    const OrientedBox b = random_box(RandomSource(5).fork(2 * k + 1), 6.0);
    double least = std::numeric_limits<double>::infinity();
    for (const Vector3d& point : grid_in(a, 40)) {
      least = std::min(least, distance_outside(b, point));
    }
    const double distance = gap_between(a, b).width;
    EXPECT_EQ(distance, gap_between(b, a).width);
    if (least == 0.0) {
      ++overlapping;
      continue;
    }
    ++apart;
    // No farther than the diagonal of a cell of the grid from the truth.
    EXPECT_LE(distance, least + 1e-9) << "pair " << k;
    EXPECT_GT(distance, least - a.size.norm() / 80.0) << "pair " << k;
  }
  EXPECT_GT(apart, 20);
  EXPECT_GT(overlapping, 5);
}

TEST(OrientedBox, BoxesThatReachIntoEachOtherAreNotApart) {
  const OrientedBox box = box_of_car(0.4);
  EXPECT_EQ(gap_between(box, box).width, 0.0);
  OrientedBox inside = box;
  inside.size *= 0.1;
  EXPECT_EQ(gap_between(box, inside).width, 0.0);
  OrientedBox corner_in = box_of_car(1.2);
  corner_in.centre = box.centre + box.axes * Vector3d(3.0, 1.0, 0.5);
  EXPECT_EQ(gap_between(box, corner_in).width, 0.0);
}

TEST(OrientedBox, BoxesThatCrossAreNotApart) {
  // Neither a corner nor the centre of one is in the other.
  const OrientedBox along{{0, 0, 1}, Matrix3d::Identity(), {10, 1, 2}};
  const OrientedBox across{{3, 1, 1}, Matrix3d::Identity(), {1, 10, 2}};
  EXPECT_EQ(gap_between(along, across).width, 0.0);
}

TEST(OrientedBox, DistanceBetweenDoesNotDependOnTheirHeights) {
  // Where both are as high as the nearest edge: a low box beside the corner of a high one, its ends farther away.
  const OrientedBox high{{0, 0, 2}, upright_axes(0.25 * std::numbers::pi), {2, 2, 4}};
  const OrientedBox low{{std::sqrt(2.0) + 1.5, 0, 1.8}, Matrix3d::Identity(), {1, 8, 0.4}};
  EXPECT_NEAR(gap_between(high, low).width, 1.0, 1e-9);
}

TEST(OrientedBox, SizeWithAnotherIsThatOfAllPointsOfBoth) {
  for (std::uint64_t k = 0; k < 40; ++k) {
    const OrientedBox a = random_box(RandomSource(6).fork(2 * k), 6.0);
    const OrientedBox b = random_box(RandomSource(6).fork(2 * k + 1), 6.0);
    Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
    Vector3d high = -low;
    for (const OrientedBox& box : {a, b}) {
      for (const Vector3d& point : grid_in(box, 4)) {
        const Vector3d q = a.axes.transpose() * point;
        low = low.cwiseMin(q);
        high = high.cwiseMax(q);
      }
    }
    EXPECT_TRUE(size_with(a, b).isApprox(high - low, 1e-12)) << "pair " << k;
  }
}

TEST(OrientedBox, FacesGoByTheirAxisAndSide) {
  // Front and rear, left and right, top and bottom: the order in which other modules write them down.
  const OrientedBox box = box_of_car(0.9);
  std::vector<Vector3d> outward;
  for (const Face face : kFaces) {
    outward.emplace_back(side_of(face) * box.axes.col(axis_of(face)));
  }
  EXPECT_EQ(outward[static_cast<std::size_t>(Face::kFront)], Vector3d(box.axes.col(0)));
  EXPECT_EQ(outward[static_cast<std::size_t>(Face::kRight)], Vector3d(-box.axes.col(1)));
  EXPECT_EQ(outward[static_cast<std::size_t>(Face::kTop)], Vector3d::UnitZ());
  EXPECT_EQ(outward[static_cast<std::size_t>(Face::kBottom)], Vector3d(-Vector3d::UnitZ()));
}

TEST(OrientedBox, TooFewPointsHaveNoYaw) {
  const Matrix3d level = Matrix3d::Identity();
  EXPECT_FALSE(fit_yaw({}, level, 0.0, 0.5));
  EXPECT_FALSE(fit_yaw(std::vector<Vector3d>(4, Vector3d::UnitX()), level, 0.0, 0.5));
  EXPECT_TRUE(std::isfinite(fit_yaw(std::vector<Vector3d>(9, Vector3d::UnitX()), level, 0.0, 0.5).value()));
}

}  // namespace
}  // namespace dynamic_icp::tracking
