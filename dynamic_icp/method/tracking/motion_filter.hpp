// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/tracking/cluster_velocity.hpp"

namespace dynamic_icp::tracking {

/// How motions change between scans: random walks of velocity and yaw rate, in units per square root of a second.
struct MotionNoise {
  double along_mps = 1.5;     ///< of the velocity, along the motion
  double across_mps = 0.5;    ///< across it, beyond what the yaw rate explains
  double vertical_mps = 0.2;  ///< upwards
  double yaw_rate_rps = 0.3;  ///< of the yaw rate
};

ConfigFields fields(MotionNoise& noise);

/// Extended Kalman filter of a body that moves with nearly constant speed and yaw rate:
///   x = [p; v; omega],  p' = v,  v' = omega z x v,  omega' = 0,  each plus noise,
/// with z the upward axis of the world. The state is 7-dimensional; nothing ties the motion to the plane but the prior
/// of the vertical velocity and its noise.
class MotionFilter {
 public:
  using Vector7d = Eigen::Matrix<double, 7, 1>;
  using Matrix7d = Eigen::Matrix<double, 7, 7>;

  MotionFilter(const Vector7d& state, const Matrix7d& covariance) : x_(state), P_(covariance) {}

  [[nodiscard]] Eigen::Vector3d position() const { return x_.head<3>(); }      ///< m, world
  [[nodiscard]] Eigen::Vector3d velocity() const { return x_.segment<3>(3); }  ///< m/s, world
  [[nodiscard]] double yaw_rate() const { return x_[6]; }                      ///< rad/s
  [[nodiscard]] const Vector7d& state() const { return x_; }
  [[nodiscard]] const Matrix7d& covariance() const { return P_; }

  /// W of `ClusterVelocity` for a sensor at `sensor_world`, and its covariance.
  [[nodiscard]] Eigen::Vector3d doppler_velocity(const Eigen::Vector3d& sensor_world) const;
  [[nodiscard]] Eigen::Matrix3d doppler_covariance(const Eigen::Vector3d& sensor_world) const;

  /// The state `dt_s` seconds later (or earlier, with as much uncertainty).
  void predict(double dt_s, const MotionNoise& noise);

  // A correction returns the logarithm of its likelihood relative to that of a measurement without error from a known
  // state: 0 at best, lower when it surprises and when little had been known before. Measurements that surprise too
  // much are taken in with less weight.

  /// Measurement of the position along a unit vector: axis . p = value.
  double correct_position(const Eigen::Vector3d& axis, double value, double variance);

  /// Measurement of the velocity along a unit vector: axis . v = value.
  double correct_velocity(const Eigen::Vector3d& axis, double value, double variance);

  /// The Doppler of one scan, W and information in world axes. `floor` is the covariance of what the regression cannot
  /// know: errors all points share.
  double correct_doppler(const ClusterVelocity& measured, const Eigen::Vector3d& sensor_world,
                         const Eigen::Matrix3d& floor);

  /// Forgets the position and starts again from another one: no displacement, hence no change of the velocity.
  void restart_position(const Eigen::Vector3d& position, double variance);

  /// Lets the reference point be another point of the body, `shift` metres away (world axes). It moves as the body
  /// turns.
  void move_reference(const Eigen::Vector3d& shift);

 private:
  using Row = Eigen::Matrix<double, 1, 7>;

  [[nodiscard]] Eigen::Matrix<double, 3, 7> doppler_jacobian(const Eigen::Vector3d& sensor_world) const;
  double correct(const Row& H, double residual, double variance);

  Vector7d x_;
  Matrix7d P_;
};

}  // namespace dynamic_icp::tracking
