// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/mapping/plane.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace dynamic_icp::mapping {
namespace {

using Eigen::Vector3d;

struct Surface {
  Vector3d origin{100.0, -40.0, 3.0};
  Eigen::Matrix3d axes = Eigen::AngleAxisd(0.7, Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  double edge_m = 1.0;

  /// Points on a plane through `origin`, spread by `wide` and `narrow` (m) in it and by `thick` across it.
  [[nodiscard]] Moments moments(int count, double wide, double narrow, double thick, unsigned seed = 1) const {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Moments sums;
    for (int i = 0; i < count; ++i) {
      sums.add(axes * Vector3d(wide * normal(random), narrow * normal(random), thick * normal(random)));
    }
    return sums;
  }
};

TEST(Moments, OfTwoSetsAddUp) {
  const Surface patch;
  Moments all;
  Moments first;
  Moments second;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 20; ++i) {
    const Vector3d point(normal(random), normal(random), normal(random));
    all.add(point);
    (i % 3 == 0 ? first : second).add(point);
  }
  EXPECT_EQ(all.weight, first.weight + second.weight);
  EXPECT_LT((all.first - first.first - second.first).norm(), 1e-12);
  EXPECT_LT((all.second - first.second - second.second).norm(), 1e-12);
}

TEST(FitPlane, FindsNormalMeanAndNoise) {
  const Surface patch;
  const auto plane = fit_plane(patch.moments(4000, 0.3, 0.2, 0.01), patch.origin, patch.edge_m, {});
  ASSERT_TRUE(plane.has_value());
  EXPECT_NEAR(std::abs(plane->normal.dot(patch.axes.col(2))), 1.0, 1e-5);
  EXPECT_NEAR(std::sqrt(plane->variance), 0.01, 5e-4);
  EXPECT_NEAR(plane->distance(patch.origin + 0.5 * plane->normal), 0.5, 2e-3);
  EXPECT_EQ(plane->points, 4000.0);
}

TEST(FitPlane, HeightVarianceIsThatOfManyFits) {
  // The spread of the fitted height over many draws, at the middle and at the rim.
  const Surface patch;
  constexpr int kDraws = 2000;
  constexpr int kPoints = 40;
  for (const Vector3d& offset : {Vector3d(0.0, 0.0, 0.0), Vector3d(0.6, 0.0, 0.0), Vector3d(0.0, 0.5, 0.0)}) {
    const Vector3d at = patch.origin + patch.axes * offset;
    double squares = 0.0;
    double predicted = 0.0;
    for (int k = 0; k < kDraws; ++k) {
      const auto plane =
          fit_plane(patch.moments(kPoints, 0.3, 0.2, 0.01, static_cast<unsigned>(k)), patch.origin, patch.edge_m, {});
      ASSERT_TRUE(plane.has_value());
      squares += std::pow(plane->distance(at), 2);
      predicted += plane->height_variance(at);
    }
    EXPECT_NEAR(predicted / squares, 1.0, 0.15) << offset.transpose();
  }
}

TEST(FitPlane, RefusesHeapsLinesAndFewPoints) {
  const Surface patch;
  EXPECT_FALSE(fit_plane(patch.moments(5, 0.3, 0.2, 0.01), patch.origin, patch.edge_m, {}).has_value());
  EXPECT_FALSE(fit_plane(patch.moments(500, 0.3, 0.2, 0.1), patch.origin, patch.edge_m, {}).has_value()) << "heap";
  EXPECT_FALSE(fit_plane(patch.moments(500, 0.3, 0.01, 0.001), patch.origin, patch.edge_m, {}).has_value()) << "line";
  EXPECT_FALSE(fit_plane(Moments{}, patch.origin, patch.edge_m, {}).has_value());
}

TEST(FitPlane, OfExactPointsHasNoNoise) {
  Moments sums;
  for (int x = 0; x < 5; ++x) {
    for (int y = 0; y < 5; ++y) {
      sums.add(Vector3d(0.1 * x, 0.1 * y, 0.25));
    }
  }
  const auto plane = fit_plane(sums, Vector3d::Zero(), 0.5, {});
  ASSERT_TRUE(plane.has_value());
  EXPECT_NEAR(plane->variance, 0.0, 1e-12);
  EXPECT_GE(plane->variance, 0.0);
  EXPECT_NEAR(plane->distance(Vector3d(7.0, -3.0, 0.25)), 0.0, 1e-6);
}

}  // namespace
}  // namespace dynamic_icp::mapping
