// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/direction_field.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "testing/dense_algebra.hpp"

namespace dynamic_icp::simulation {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

TEST(DirectionField, ClosesWhereTheSensorSeesAllAround) {
  const DirectionField field(0.15, {360.0 * kDegree, 40.0 * kDegree, -5.0 * kDegree}, RandomSource(3));
  for (double elevation = -25.0; elevation < 15.0; elevation += 5.0) {
    EXPECT_NEAR(field.at(-180.0 * kDegree, elevation * kDegree), field.at(180.0 * kDegree, elevation * kDegree), 1e-12);
  }
}

TEST(DirectionField, LooksAtRestLikeTheMotionThatARecordedUnitShows) {
  // HeRCULES: a unit at rest shows a mean motion of 0.29 m/s, (0.175, 0.181, -0.135) m/s.
  const double half_width = 60.0, half_height = 9.6;
  double squares = 0.0;
  const int units = 40;
  for (std::uint64_t unit = 0; unit < units; ++unit) {
    const DirectionField field(0.15, {2.0 * half_width * kDegree, 2.0 * half_height * kDegree, 0.0},
                               RandomSource(unit));
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (double az = -half_width; az <= half_width; az += 2.0) {
      for (double el = -half_height; el <= half_height; el += 1.2) {
        const double a = az * kDegree, e = el * kDegree;
        const Eigen::Vector3d u(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
        A += u * u.transpose();
        b -= u * field.at(a, e);
      }
    }
    squares += dense::solve(A, b).squaredNorm() / units;
  }
  EXPECT_GT(std::sqrt(squares), 0.15);
  EXPECT_LT(std::sqrt(squares), 0.45);
}

TEST(DirectionField, IsNothingWithoutSize) {
  EXPECT_EQ(DirectionField(0.0, {1.0, 0.3, 0.0}, RandomSource(1)).at(0.3, 0.1), 0.0);
}

}  // namespace
}  // namespace dynamic_icp::simulation
