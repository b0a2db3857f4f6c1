// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/motion/motion_uncertainty.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace dynamic_icp::motion {
namespace {

// Keeps information invertible where there is none: standard deviations of a kilometre and of a thousand radians.
constexpr double kMinInformation = 1e-6;

Eigen::Matrix3d inverse(const Eigen::Matrix3d& matrix) { return matrix.ldlt().solve(Eigen::Matrix3d::Identity()); }

Eigen::Matrix3d covariance_of(const Eigen::Matrix3d& information) {
  return inverse(information + kMinInformation * Eigen::Matrix3d::Identity());
}

/// The covariance of [omega * length_m; rho], all in metres.
Matrix6d in_metres(const Matrix6d& covariance, double length_m) {
  Vector6d scale = Vector6d::Ones();
  scale.head<3>().setConstant(length_m);
  return scale.asDiagonal() * covariance * scale.asDiagonal();
}

}  // namespace

Matrix6d motion_covariance(const MotionEvidence& evidence, const Eigen::Matrix3d& R_map_target) {
  const Eigen::Matrix3d by_map =
      covariance_of(evidence.source_position_information) + covariance_of(evidence.target_position_information);
  const Eigen::Matrix3d displacement = covariance_of(inverse(evidence.displacement_covariance) + inverse(by_map));
  Matrix6d covariance = Matrix6d::Zero();
  covariance.topLeftCorner<3, 3>() = R_map_target.transpose() *
                                     (evidence.source_rotation_covariance + evidence.target_rotation_covariance) *
                                     R_map_target;
  covariance.bottomRightCorner<3, 3>() = R_map_target.transpose() * displacement * R_map_target;
  const Eigen::Matrix3d J = -skew(evidence.displacement_rotated);
  const Eigen::Matrix3d rotation = covariance.topLeftCorner<3, 3>();
  covariance.bottomRightCorner<3, 3>() += J * rotation * J.transpose();
  covariance.bottomLeftCorner<3, 3>() = J * rotation;
  covariance.topRightCorner<3, 3>() = rotation * J.transpose();
  return 0.5 * (covariance + covariance.transpose());
}

Eigen::Matrix3d position_information(const Matrix6d& information) {
  const Eigen::Matrix3d cross = information.topRightCorner<3, 3>();
  return information.bottomRightCorner<3, 3>() -
         cross.transpose() * covariance_of(information.topLeftCorner<3, 3>()) * cross;
}

std::vector<estimation::DegenerateDirection> unobservable_directions(const Matrix6d& covariance, double length_m,
                                                                     double deviation_m) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(in_metres(covariance, length_m));
  std::vector<estimation::DegenerateDirection> unknown;
  for (int k = 5; k >= 0 && eigen.eigenvalues()[k] > deviation_m * deviation_m; --k) {
    unknown.push_back({eigen.eigenvectors().col(k), std::max(0.0, eigen.eigenvalues()[0]) / eigen.eigenvalues()[k]});
  }
  return unknown;
}

double information_ratio(const Matrix6d& covariance, double length_m) {
  const Vector6d values = in_metres(covariance, length_m).selfadjointView<Eigen::Lower>().eigenvalues();
  return values[5] > 0.0 ? std::max(0.0, values[0]) / values[5] : 0.0;
}

Twist twist_at_stamp(const RotationState& rotation, const ego_motion::EgoVelocity& ego, double middle_s) {
  Twist twist;
  twist.angular = rotation.omega;
  twist.linear = ego.velocity_sensor - middle_s * ego.acceleration_sensor;
  twist.covariance.topLeftCorner<3, 3>() = rotation.covariance.block<3, 3>(3, 3);
  twist.covariance.bottomRightCorner<3, 3>() = ego.covariance;
  return twist;
}

}  // namespace dynamic_icp::motion
