// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/ground_fit.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::tracking {
namespace {

using ego_motion::SupportPlane;
using Eigen::Vector3d;

constexpr double kDegree = 0.017453292519943295;

double angle_of(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// A road seen from a leaning sensor 1.8 m above it, and what may be beside it.
struct Street {
  SupportPlane road{exp_so3(Vector3d(0.03, -0.02, 0.0)).col(2), -1.8};
  std::vector<Vector3d> points;
  std::vector<std::uint8_t> is_moving;
  RandomSource random{7};

  /// `height`: over the road, m, of the place that is `ahead` and `left` of the sensor.
  template <typename Height>
  void add(int count, double ahead_from, double ahead_to, double left_from, double left_to, const Height& height,
           bool moves = false) {
    const Eigen::Matrix3d R = exp_so3(Vector3d(0.03, -0.02, 0.0));
    for (int i = 0; i < count; ++i) {
      const double ahead = random.uniform(3 * points.size(), ahead_from, ahead_to);
      const double left = random.uniform(3 * points.size() + 1, left_from, left_to);
      const double noise = 0.02 * random.normal(3 * points.size() + 2);
      points.push_back(R * Vector3d(ahead, left, height(ahead, left) - 1.8 + noise));
      is_moving.push_back(moves ? 1 : 0);
    }
  }
};

constexpr auto kFlat = [](double, double) { return 0.0; };

TEST(FitGround, FindsTheRoadFromAPlaneThatLeansOnWhatIsBesideIt) {
  Street street;
  street.add(1200, 11.0, 35.0, -7.0, 7.0, kFlat);
  street.add(400, 11.0, 35.0, 7.0, 12.0, [](double, double left) { return 0.3 * (left - 7.0); });  // an embankment
  const SupportPlane start{exp_so3(Vector3d(2.0 * kDegree, 0.5 * kDegree, 0.0)) * street.road.normal, -1.65};
  const auto fit = fit_ground(start, street.points, street.is_moving);
  ASSERT_TRUE(fit);
  EXPECT_LT(angle_of(fit->plane.normal, street.road.normal), 0.15 * kDegree);
  EXPECT_NEAR(fit->plane.offset_m, street.road.offset_m, 0.02);
  EXPECT_NEAR(fit->plane.normal.norm(), 1.0, 1e-12);
  EXPECT_GT(fit->points, 1100U);
}

TEST(FitGround, OfANarrowStripOfRoadNoPlaneThatLeansOnTheEmbankmentIsFound) {
  // Three metres to either side are seen: a plane that is 2 degrees off is nowhere more than 0.1 m away from the road.
  Street street;
  street.add(400, 11.0, 16.0, -3.0, 3.0, kFlat);
  street.add(400, 11.0, 40.0, 3.0, 9.0, [](double ahead, double left) {
    return 0.05 * (left - 3.0) + 0.08 * std::sin(3.0 * ahead);  // grass
  });
  const SupportPlane start{exp_so3(Vector3d(2.0 * kDegree, 0.0, 0.0)) * street.road.normal, -1.8};
  const auto fit = fit_ground(start, street.points, street.is_moving);
  ASSERT_TRUE(fit);
  EXPECT_LT(angle_of(fit->plane.normal, street.road.normal), 0.8 * kDegree);
}

TEST(FitGround, WhatMovesIsNoGround) {
  Street street;
  street.add(300, 11.0, 35.0, -7.0, 7.0, kFlat);
  street.add(
      3000, 11.0, 35.0, -7.0, 7.0, [](double, double) { return 0.2; }, true);  // below many cars
  const auto fit = fit_ground(street.road, street.points, street.is_moving);
  ASSERT_TRUE(fit);
  EXPECT_LT(angle_of(fit->plane.normal, street.road.normal), 0.05 * kDegree);
  EXPECT_NEAR(fit->plane.offset_m, street.road.offset_m, 0.01);
}

TEST(FitGround, AStripDoesNotSayHowTheRoadLeansAcrossIt) {
  Street street;
  street.add(500, 11.0, 35.0, -0.01, 0.01, kFlat);
  const SupportPlane start{exp_so3(Vector3d(0.01, 0.0, 0.0)) * street.road.normal, -1.8};
  const auto fit = fit_ground(start, street.points, street.is_moving);
  ASSERT_TRUE(fit);
  EXPECT_LT(angle_of(fit->plane.normal, start.normal), 0.1 * kDegree) << "nothing says how it leans: as before";
}

TEST(FitGround, FewPointsShowNone) {
  Street street;
  street.add(20, 11.0, 35.0, -7.0, 7.0, kFlat);
  EXPECT_FALSE(fit_ground(street.road, street.points, street.is_moving));
  EXPECT_FALSE(fit_ground(street.road, {}, {}));
}

TEST(FitGround, CountsAllPointsHoweverManyFillTheLanes) {
  Street street;
  street.add(30, 11.0, 35.0, -7.0, 7.0, kFlat);
  for (; street.points.size() < 50; street.add(1, 11.0, 35.0, -7.0, 7.0, kFlat)) {
    for (Vector3d& point : street.points) {  // without noise
      point -= street.road.height(point) * street.road.normal;
    }
    const auto fit = fit_ground(street.road, street.points, street.is_moving);
    ASSERT_TRUE(fit);
    EXPECT_EQ(fit->points, street.points.size());
    EXPECT_LT(angle_of(fit->plane.normal, street.road.normal), 1e-12);
    EXPECT_NEAR(fit->plane.offset_m, street.road.offset_m, 1e-12);
  }
}

TEST(LikelierGround, IsTheNearerOneUnlessItHasFarFewerPoints) {
  const GroundFit road{{Vector3d::UnitZ(), -1.8}, 400};
  const GroundFit embankment{{exp_so3(Vector3d(0.2, 0.0, 0.0)).col(2), -4.0}, 700};
  const GroundFit roofs{{Vector3d::UnitZ(), -0.1}, 90};
  EXPECT_EQ(&likelier_ground(road, embankment), &road);
  EXPECT_EQ(&likelier_ground(embankment, road), &road);
  EXPECT_EQ(&likelier_ground(road, roofs), &road);
  EXPECT_EQ(&likelier_ground(roofs, road), &road);
  const GroundFit leaning{{exp_so3(Vector3d(0.03, 0.0, 0.0)).col(2), -1.7}, 300};
  EXPECT_EQ(&likelier_ground(road, leaning), &road) << "of about the same plane that with more points";
  EXPECT_EQ(&likelier_ground(leaning, road), &road);
}

}  // namespace
}  // namespace dynamic_icp::tracking
