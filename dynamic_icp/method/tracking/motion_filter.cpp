// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/motion_filter.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Measurements more than this many standard deviations off count as if they were just so many off (Huber's influence).
constexpr double kLargestInnovation = 3.0;
constexpr double kWorstSquare = 16.0;     // of a normalised residual, for the likelihood: all may happen
constexpr double kMinInformation = 1e-4;  // (s/m)^2: a standard deviation of 100 m/s

const Vector3d kUp = Vector3d::UnitZ();

/// Covariance of the velocity's random walk over one second, along and across the motion.
Matrix3d velocity_noise(const Vector3d& velocity, const MotionNoise& noise) {
  const double speed = velocity.head<2>().norm();
  const Vector3d along = speed > 0.0 ? Vector3d(velocity.x() / speed, velocity.y() / speed, 0.0) : Vector3d::UnitX();
  const Vector3d across = kUp.cross(along);
  return noise.along_mps * noise.along_mps * along * along.transpose() +
         noise.across_mps * noise.across_mps * across * across.transpose() +
         noise.vertical_mps * noise.vertical_mps * kUp * kUp.transpose();
}

}  // namespace

ConfigFields fields(MotionNoise& noise) {
  return {
      {"along_mps", &noise.along_mps, 0.01, 100.0, "m/s/sqrt(s)", "random walk of an object's speed along its motion"},
      {"across_mps", &noise.across_mps, 0.01, 100.0, "m/s/sqrt(s)",
       "random walk of its velocity across the motion, beyond what its yaw rate explains"},
      {"vertical_mps", &noise.vertical_mps, 0.01, 100.0, "m/s/sqrt(s)", "random walk of its vertical velocity"},
      {"yaw_rate_rps", &noise.yaw_rate_rps, 0.001, 100.0, "rad/s/sqrt(s)", "random walk of its yaw rate"},
  };
}

void MotionFilter::predict(double dt_s, const MotionNoise& noise) {
  const Vector3d v = velocity();
  const Matrix3d turn = exp_so3(kUp * (yaw_rate() * dt_s));
  const Matrix3d half_turn = exp_so3(kUp * (0.5 * yaw_rate() * dt_s));
  Matrix7d F = Matrix7d::Identity();
  F.block<3, 3>(0, 3) = dt_s * half_turn;
  F.block<3, 1>(0, 6) = 0.5 * dt_s * dt_s * kUp.cross(half_turn * v);
  F.block<3, 3>(3, 3) = turn;
  F.block<3, 1>(3, 6) = dt_s * kUp.cross(turn * v);
  const double t = std::abs(dt_s);
  const Matrix3d q = velocity_noise(v, noise);
  Matrix7d Q = Matrix7d::Zero();
  // White noise of the acceleration over t.
  Q.block<3, 3>(0, 0) = t * t * t / 3.0 * q;
  Q.block<3, 3>(0, 3) = (dt_s < 0.0 ? -1.0 : 1.0) * t * t / 2.0 * q;
  Q.block<3, 3>(3, 0) = Q.block<3, 3>(0, 3);
  Q.block<3, 3>(3, 3) = t * q;
  Q(6, 6) = t * noise.yaw_rate_rps * noise.yaw_rate_rps;
  x_.head<3>() += dt_s * half_turn * v;
  x_.segment<3>(3) = turn * v;
  P_ = F * P_ * F.transpose() + Q;
}

double MotionFilter::correct(const Row& H, double residual, double variance) {
  const Vector7d PHt = P_ * H.transpose();
  const double predicted = H * PHt;
  double S = predicted + variance;
  const double log_likelihood = -0.5 * std::min(residual * residual / S, kWorstSquare) - 0.5 * std::log(S / variance);
  const double excess = std::abs(residual) / (kLargestInnovation * std::sqrt(S));
  if (excess > 1.0) {
    variance = excess * S - predicted;
    S = predicted + variance;
  }
  const Vector7d K = PHt / S;
  x_ += K * residual;
  // Joseph's form stays symmetric and positive.
  const Matrix7d I_KH = Matrix7d::Identity() - K * H;
  P_ = I_KH * P_ * I_KH.transpose() + variance * K * K.transpose();
  return log_likelihood;
}

double MotionFilter::correct_position(const Vector3d& axis, double value, double variance) {
  Row H = Row::Zero();
  H.head<3>() = axis.transpose();
  return correct(H, value - axis.dot(position()), variance);
}

double MotionFilter::correct_velocity(const Vector3d& axis, double value, double variance) {
  Row H = Row::Zero();
  H.segment<3>(3) = axis.transpose();
  return correct(H, value - axis.dot(velocity()), variance);
}

Vector3d MotionFilter::doppler_velocity(const Vector3d& sensor_world) const {
  return velocity() - yaw_rate() * kUp.cross(position() - sensor_world);
}

Eigen::Matrix<double, 3, 7> MotionFilter::doppler_jacobian(const Vector3d& sensor_world) const {
  Eigen::Matrix<double, 3, 7> H;
  H.leftCols<3>() = -yaw_rate() * skew(kUp);
  H.middleCols<3>(3).setIdentity();
  H.col(6) = -kUp.cross(position() - sensor_world);
  return H;
}

Matrix3d MotionFilter::doppler_covariance(const Vector3d& sensor_world) const {
  const Eigen::Matrix<double, 3, 7> H = doppler_jacobian(sensor_world);
  return H * P_ * H.transpose();
}

double MotionFilter::correct_doppler(const ClusterVelocity& measured, const Vector3d& sensor_world,
                                     const Matrix3d& floor) {
  double log_likelihood = 0.0;
  // The parts along the eigenvectors are independent of each other; those without information drop out.
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(measured.information);
  for (int i = 2; i >= 0; --i) {
    const double information = eigen.eigenvalues()[i];
    if (information < kMinInformation) {
      continue;
    }
    const Vector3d e = eigen.eigenvectors().col(i);
    const Row H = e.transpose() * doppler_jacobian(sensor_world);
    const double residual = e.dot(measured.W - doppler_velocity(sensor_world));
    log_likelihood += correct(H, residual, 1.0 / information + e.dot(floor * e));
  }
  return log_likelihood;
}

void MotionFilter::restart_position(const Vector3d& position, double variance) {
  x_.head<3>() = position;
  P_.topRows<3>().setZero();
  P_.leftCols<3>().setZero();
  P_.topLeftCorner<3, 3>().diagonal().setConstant(variance);
}

void MotionFilter::move_reference(const Vector3d& shift) {
  Matrix7d F = Matrix7d::Identity();
  F.block<3, 1>(3, 6) = kUp.cross(shift);
  x_.head<3>() += shift;
  x_.segment<3>(3) += yaw_rate() * kUp.cross(shift);
  P_ = F * P_ * F.transpose();
}

}  // namespace dynamic_icp::tracking
