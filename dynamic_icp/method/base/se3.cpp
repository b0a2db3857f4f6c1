// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/se3.hpp"

#include <cmath>

namespace dynamic_icp {
namespace {

// Below this squared angle the power series is exact to double precision and the closed forms lose digits.
constexpr double kSmallAngleSquared = 1e-3;

/// The left Jacobian of SO(3): translation of a twist = V(omega) rho.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& omega) {
  const double x = omega.squaredNorm();
  double a = 1.0 / 2.0 - x * (1.0 / 24.0 - x * (1.0 / 720.0 - x / 40320.0));     // (1 - cos) / angle^2
  double b = 1.0 / 6.0 - x * (1.0 / 120.0 - x * (1.0 / 5040.0 - x / 362880.0));  // (angle - sin) / angle^3
  if (x > kSmallAngleSquared) {
    const double angle = std::sqrt(x);
    a = (1.0 - std::cos(angle)) / x;
    b = (angle - std::sin(angle)) / (x * angle);
  }
  const Eigen::Matrix3d W = skew(omega);
  return Eigen::Matrix3d::Identity() + a * W + b * W * W;
}

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d W;
  W << 0.0, -v.z(), v.y(),  //
      v.z(), 0.0, -v.x(),   //
      -v.y(), v.x(), 0.0;
  return W;
}

Eigen::Matrix3d exp_so3(const Eigen::Vector3d& omega) {
  // Through the quaternion [cos(|w|/2), sin(|w|/2) w/|w|]: unit length and orthogonality come for free.
  const double angle = omega.norm();
  const double half = 0.5 * angle;
  const double sine_over_angle = angle > 1e-8 ? std::sin(half) / angle : 0.5 - angle * angle / 48.0;
  const Eigen::Vector3d q = sine_over_angle * omega;
  return Eigen::Quaterniond(std::cos(half), q.x(), q.y(), q.z()).normalized().toRotationMatrix();
}

Eigen::Vector3d log_so3(const Eigen::Matrix3d& R) {
  Eigen::Quaterniond q(R);
  if (q.w() < 0.0) {
    q.coeffs() = -q.coeffs();  // the shorter way round
  }
  const double sine = q.vec().norm();
  const double angle = 2.0 * std::atan2(sine, q.w());
  const double angle_over_sine = sine > 1e-8 ? angle / sine : 2.0 / q.w();
  return angle_over_sine * q.vec();
}

Eigen::Matrix3d right_jacobian_so3(const Eigen::Vector3d& omega) { return left_jacobian(-omega); }

Eigen::Isometry3d exp_se3(const Vector6d& xi) {
  const Eigen::Vector3d omega = xi.head<3>();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = exp_so3(omega);
  T.translation() = left_jacobian(omega) * xi.tail<3>();
  return T;
}

Vector6d log_se3(const Eigen::Isometry3d& T) {
  Vector6d xi;
  xi.head<3>() = log_so3(T.linear());
  xi.tail<3>() = left_jacobian(xi.head<3>()).partialPivLu().solve(T.translation());
  return xi;
}

double rotation_angle(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  return 2.0 * std::atan2(q.vec().norm(), std::abs(q.w()));
}

}  // namespace dynamic_icp
