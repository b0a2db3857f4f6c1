// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// The two residuals of the objective against the equations: numeric derivatives, invariance under a common turn of both
// scans, independence of units.
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "dynamic_icp/registration/doppler_rotation.hpp"
#include "dynamic_icp/registration/point_to_plane.hpp"

namespace dynamic_icp::registration {
namespace {

using Eigen::Vector3d;

class ResidualTest : public ::testing::Test {
 protected:
  double uniform(double size) { return size * std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  Vector3d vector(double size) { return {uniform(size), uniform(size), uniform(size)}; }
  Eigen::Isometry3d pose() {
    Vector6d xi;
    xi << vector(0.5), vector(3.0);
    return exp_se3(xi);
  }

  std::mt19937 random_{42};
};

/// Central differences over a left perturbation of the pose.
Vector6d numeric_jacobian(const std::function<double(const Eigen::Isometry3d&)>& residual, const Eigen::Isometry3d& T) {
  constexpr double kStep = 1e-6;
  Vector6d jacobian;
  for (int k = 0; k < 6; ++k) {
    const Vector6d xi = kStep * Vector6d::Unit(k);
    jacobian[k] = (residual(exp_se3(xi) * T) - residual(exp_se3(-xi) * T)) / (2.0 * kStep);
  }
  return jacobian;
}

TEST_F(ResidualTest, PointToPlaneJacobianEqualsTheNumericOne) {
  for (int repeat = 0; repeat < 100; ++repeat) {
    const Vector3d p = vector(50.0);
    const Vector3d q = vector(50.0);
    const Vector3d n = vector(1.0).normalized();
    const Eigen::Isometry3d T = pose();
    const auto residual = [&](const Eigen::Isometry3d& X) { return n.dot(X.linear() * p + X.translation() - q); };
    const Residual analytic = point_to_plane(T * p, q, n);
    EXPECT_NEAR(analytic.value, residual(T), 1e-12);
    EXPECT_LT((analytic.jacobian - numeric_jacobian(residual, T)).norm(), 1e-6);
  }
}

TEST_F(ResidualTest, DopplerRotationJacobianEqualsTheNumericOne) {
  for (int repeat = 0; repeat < 100; ++repeat) {
    const Vector3d u_i = vector(1.0).normalized();
    const Vector3d u_j = vector(1.0).normalized();
    const double s_i = uniform(30.0);
    const double s_j = uniform(30.0);
    const Eigen::Isometry3d T = pose();
    const auto residual = [&](const Eigen::Isometry3d& X) { return u_j.dot(X.linear() * (s_i * u_i)) - s_j; };
    const Residual analytic = doppler_rotation(T.linear() * (s_i * u_i), u_j, s_j);
    EXPECT_NEAR(analytic.value, residual(T), 1e-12);
    EXPECT_LT((analytic.jacobian - numeric_jacobian(residual, T)).norm(), 1e-7);
    EXPECT_EQ(analytic.jacobian[3], 0.0);
    EXPECT_EQ(analytic.jacobian[4], 0.0);
    EXPECT_EQ(analytic.jacobian[5], 0.0);
  }
}

TEST_F(ResidualTest, DopplerRotationIsBlindWhereTheLinesOfSightAgree) {
  const Vector3d u = vector(1.0).normalized();
  EXPECT_TRUE(doppler_rotation(12.0 * u, u, 12.0).jacobian.isZero(1e-12));
}

TEST_F(ResidualTest, SlidingAlongThePlaneCostsNothingHoweverThePlaneIsTurned) {
  const Vector3d n = vector(1.0).normalized();
  const Vector3d along = n.cross(vector(1.0)).normalized();
  const Vector3d q = vector(10.0);
  EXPECT_NEAR(point_to_plane(q + 0.1 * along, q, n).value, 0.0, 1e-15);
  EXPECT_NEAR(point_to_plane(q + 0.1 * n, q, n).value, 0.1, 1e-14);
}

TEST_F(ResidualTest, TurningBothScansChangesNoValue) {
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Eigen::Matrix3d Q = exp_so3(vector(2.0));
    const Vector3d moved = vector(20.0);
    const Vector3d q = vector(20.0);
    const Vector3d n = vector(1.0).normalized();
    EXPECT_NEAR(point_to_plane(Q * moved, Q * q, Q * n).value, point_to_plane(moved, q, n).value, 1e-12);
    const Vector3d ray = vector(10.0);
    const Vector3d u = vector(1.0).normalized();
    EXPECT_NEAR(doppler_rotation(Q * ray, Q * u, 3.0).value, doppler_rotation(ray, u, 3.0).value, 1e-12);
  }
}

}  // namespace
}  // namespace dynamic_icp::registration
