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

/// Lines of points on the ground that a sensor 2 m above it sees 12 m ahead; their ranges err by `sigma_m`.
Moments lines_on_the_ground(int lines, double sigma_m, unsigned seed, Vector3d& origin, Vector3d& sensor) {
  sensor = Vector3d(-30.0, 5.0, 2.0);
  origin = sensor + Vector3d(12.0, 0.0, -2.0);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Moments sums;
  for (int line = 0; line < lines; ++line) {
    for (int i = 0; i < 40; ++i) {
      const Vector3d on_ground = origin + Vector3d(0.5 * (line - 0.5 * (lines - 1)), 0.05 * (i - 20), 0.0);
      const Vector3d line_of_sight = (on_ground - sensor).normalized();
      sums.add(on_ground + sigma_m * normal(random) * line_of_sight - origin);
    }
  }
  return sums;
}

TEST(FitPlane, NoiseOfRangesTiltsNoPlaneThatIsSeenAtAGrazingAngle) {
  constexpr double kRange_m = 0.05;
  constexpr int kTrials = 400;
  double slope = 0.0;
  double slope_squares = 0.0;
  double slope_of_scatter = 0.0;
  double variance = 0.0;
  for (unsigned k = 0; k < kTrials; ++k) {
    Vector3d origin;
    Vector3d sensor;
    const Moments sums = lines_on_the_ground(2, kRange_m, k, origin, sensor);
    const auto plane = fit_plane(sums, origin, 2.0, {}, {sensor, kRange_m * kRange_m});
    const auto tilted = fit_plane(sums, origin, 2.0, {});
    ASSERT_TRUE(plane && tilted);
    const double dz_dx = -plane->normal.x() / plane->normal.z();
    slope += dz_dx / kTrials;
    slope_squares += dz_dx * dz_dx / kTrials;
    slope_of_scatter += -tilted->normal.x() / tilted->normal.z() / kTrials;
    variance += plane->variance / kTrials;
  }
  // Two lines 0.5 m apart: the slope that the noise adds is -sigma^2 sin cos / (0.25 m)^2.
  const double sine = 2.0 / std::sqrt(148.0);
  const double cosine = 12.0 / std::sqrt(148.0);
  EXPECT_NEAR(slope_of_scatter, -kRange_m * kRange_m * sine * cosine / 0.0625, 1e-3);
  EXPECT_LT(std::abs(slope), 4.0 * std::sqrt(slope_squares / kTrials) + 2e-4);
  EXPECT_LT(std::abs(slope), 0.15 * std::abs(slope_of_scatter));
  // Points err across the plane by what the line of sight does.
  EXPECT_NEAR(std::sqrt(variance), kRange_m * sine, 0.2 * kRange_m * sine);
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
