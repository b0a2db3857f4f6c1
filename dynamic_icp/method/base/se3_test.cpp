// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/se3.hpp"

#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <unsupported/Eigen/MatrixFunctions>

namespace dynamic_icp {
namespace {

Eigen::Vector3d random_vector(std::mt19937& random, double scale) {
  std::uniform_real_distribution<double> uniform(-scale, scale);
  return {uniform(random), uniform(random), uniform(random)};
}

/// The 4x4 matrix of a twist, whose matrix exponential is the motion by definition.
Eigen::Matrix4d twist_matrix(const Vector6d& xi) {
  Eigen::Matrix4d X = Eigen::Matrix4d::Zero();
  X.topLeftCorner<3, 3>() = skew(xi.head<3>());
  X.topRightCorner<3, 1>() = xi.tail<3>();
  return X;
}

TEST(Se3, SkewIsTheCrossProduct) {
  std::mt19937 random(1);
  const Eigen::Vector3d a = random_vector(random, 2.0);
  const Eigen::Vector3d b = random_vector(random, 2.0);
  EXPECT_TRUE((skew(a) * b).isApprox(a.cross(b), 1e-15));
}

TEST(Se3, ExponentialEqualsTheMatrixExponential) {
  std::mt19937 random(2);
  for (const double scale : {1e-12, 1e-9, 1e-6, 1e-4, 1e-2, 0.5, 1.7}) {
    Vector6d xi;
    xi << random_vector(random, scale), random_vector(random, 3.0);
    const Eigen::Matrix4d expected = twist_matrix(xi).exp();
    EXPECT_LT((exp_se3(xi).matrix() - expected).norm(), 1e-13) << "scale " << scale;
  }
}

TEST(Se3, LogarithmInvertsTheExponential) {
  std::mt19937 random(3);
  for (const double scale : {1e-12, 1e-9, 1e-5, 1e-3, 0.3, 1.7}) {
    for (int k = 0; k < 50; ++k) {
      Vector6d xi;
      xi << random_vector(random, scale), random_vector(random, 5.0);
      EXPECT_LT((log_se3(exp_se3(xi)) - xi).norm(), 1e-12) << "scale " << scale;
    }
  }
}

TEST(Se3, RightJacobianIsTheDerivativeOfTheExponential) {
  // Both sides of where the power series ends, and as far as a rotation goes.
  constexpr double kStep = 1e-5;
  std::mt19937 random(5);
  for (const double length : {0.0, 1e-9, 1e-3, 0.0315, 0.0318, 0.4, 1.7, 3.0}) {
    const Eigen::Vector3d omega = length * random_vector(random, 1.0).normalized();
    const Eigen::Matrix3d J = right_jacobian_so3(omega);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector3d change = log_so3(exp_so3(omega - d).transpose() * exp_so3(omega + d)) / (2.0 * kStep);
      EXPECT_LT((J.col(axis) - change).norm(), 1e-9) << "length " << length;
    }
    EXPECT_LT((J * omega - omega).norm(), 1e-14) << "along the axis nothing changes";
  }
}

TEST(Se3, LogarithmNearHalfATurn) {
  std::mt19937 random(4);
  for (const double below_pi : {0.0, 1e-12, 1e-8, 1e-4}) {
    const Eigen::Vector3d omega = (std::numbers::pi - below_pi) * random_vector(random, 1.0).normalized();
    const Eigen::Matrix3d R = exp_so3(omega);
    EXPECT_LT((exp_so3(log_so3(R)) - R).norm(), 1e-14);
    EXPECT_NEAR(log_so3(R).norm(), omega.norm(), 1e-12);
  }
}

TEST(Se3, AngleIsAccurateWhereTheTraceIsNot) {
  // acos((trace - 1) / 2) gives 0 or 2e-8 here.
  EXPECT_NEAR(rotation_angle(exp_so3({1e-9, 0.0, 0.0})), 1e-9, 1e-18);
  EXPECT_NEAR(rotation_angle(exp_so3({0.0, 0.3, 0.4})), 0.5, 1e-15);
  EXPECT_NEAR(rotation_angle(exp_so3({0.0, 0.0, 3.0})), 3.0, 1e-15);
}

}  // namespace
}  // namespace dynamic_icp
