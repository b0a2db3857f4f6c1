// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// The residuals of the objectives against the equations: numeric derivatives, invariance under a common turn of both
// scans, independence of units.
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "dynamic_icp/method/registration/doppler_rotation.hpp"
#include "dynamic_icp/method/registration/plane_to_plane.hpp"
#include "dynamic_icp/method/registration/point_to_plane.hpp"
#include "dynamic_icp/method/registration/point_to_point.hpp"
#include "dynamic_icp/method/registration/sensor_velocity.hpp"

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

TEST_F(ResidualTest, PointToPointJacobianEqualsTheNumericOne) {
  for (int repeat = 0; repeat < 100; ++repeat) {
    const Vector3d p = vector(50.0);
    const Vector3d q = vector(50.0);
    const Eigen::Isometry3d T = pose();
    const VectorResidual analytic = point_to_point(T * p, q);
    EXPECT_LT((analytic.value - (T * p - q)).norm(), 1e-12);
    for (int axis = 0; axis < 3; ++axis) {
      const auto residual = [&](const Eigen::Isometry3d& X) { return (X * p - q)[axis]; };
      EXPECT_LT((analytic.jacobian.row(axis).transpose() - numeric_jacobian(residual, T)).norm(), 1e-6);
    }
  }
}

TEST_F(ResidualTest, PlaneToPlaneInformationIsTheInverseOfTheSumOfTheCovariances) {
  for (int repeat = 0; repeat < 100; ++repeat) {
    const Vector3d n_source = vector(1.0).normalized();
    const Vector3d n_target = vector(1.0).normalized();
    const double thickness = 1e-3;
    // Covariances built the other way round: from a frame with the normal as its first axis.
    const auto covariance = [&](const Vector3d& n) {
      const Eigen::Matrix3d R = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitX(), n).toRotationMatrix();
      return Eigen::Matrix3d(R * Vector3d(thickness, 1.0, 1.0).asDiagonal() * R.transpose());
    };
    const Eigen::Matrix3d information = plane_to_plane_information(n_source, n_target, thickness);
    EXPECT_LT((information * (covariance(n_source) + covariance(n_target)) - Eigen::Matrix3d::Identity()).norm(), 1e-9);
  }
  EXPECT_TRUE(
      plane_to_plane_information(Vector3d::Zero(), Vector3d::Zero(), 1e-3).isApprox(0.5 * Eigen::Matrix3d::Identity()));
}

TEST_F(ResidualTest, SensorVelocityVanishesForAStaticPointOfAStraightOrTurningDrive) {
  for (int repeat = 0; repeat < 100; ++repeat) {
    const VehicleMotion motion{vector(2.0), 0.1};
    const Vector3d velocity_vehicle = vector(20.0);
    const Vector3d omega = vector(0.5);
    const Vector3d direction = vector(1.0).normalized();
    const double doppler = -direction.dot(velocity_vehicle + omega.cross(motion.sensor_vehicle));
    // The motion that the published model assigns to these velocities.
    const Residual residual =
        sensor_velocity(-motion.dt_s * omega, -motion.dt_s * velocity_vehicle, direction, doppler, motion);
    EXPECT_NEAR(residual.value, 0.0, 1e-12);
  }
}

TEST_F(ResidualTest, SensorVelocityJacobianIsThatOfAddingToThetaAndT) {
  for (int repeat = 0; repeat < 100; ++repeat) {
    const VehicleMotion motion{vector(2.0), 0.1};
    const Vector3d theta = vector(0.3);
    const Vector3d translation = vector(2.0);
    const Vector3d direction = vector(1.0).normalized();
    const Residual analytic = sensor_velocity(theta, translation, direction, 3.0, motion);
    constexpr double kStep = 1e-6;
    for (int k = 0; k < 6; ++k) {
      const Vector6d step = kStep * Vector6d::Unit(k);
      const auto at = [&](double sign) {
        return sensor_velocity(theta + sign * step.head<3>(), translation + sign * step.tail<3>(), direction, 3.0,
                               motion)
            .value;
      };
      EXPECT_NEAR(analytic.jacobian[k], (at(1.0) - at(-1.0)) / (2.0 * kStep), 1e-6);
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::registration
