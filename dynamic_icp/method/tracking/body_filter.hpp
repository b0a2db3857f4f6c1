// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/tracking/cluster_velocity.hpp"
#include "dynamic_icp/method/tracking/oriented_box.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::tracking {

/// How motions change between scans: random walks of velocity and yaw rate, in units per square root of a second, and
/// what comes back to zero: accelerations, and vertical velocities, as what stands on the ground follows it.
struct MotionNoise {
  double along_mps = 1.5;      ///< of the velocity of a body without heading, along the motion
  double across_mps = 0.5;     ///< of any velocity, beyond what yaw rate and acceleration explain
  double vertical_mps = 0.25;  ///< m/s: standard deviation of the vertical velocity, which lasts a second
  double yaw_rate_rps = 0.3;   ///< of the yaw rate
  double acceleration_mps2 =
      1.5;              ///< m/s^2: standard deviation of that of a body with heading, which lasts two seconds
  double slope = 0.02;  ///< of roads: so much of the speed is in the vertical velocity, too
};

ConfigFields fields(MotionNoise& noise);

/// Extended Kalman filter of an upright box that moves with nearly constant acceleration and yaw rate:
///   x = [p; v; yaw; omega; a; d],  p' = v,  v' = omega z x v + a h - z (z . v) / 1 s,
///   yaw' = omega,  omega' = 0,  a' = -a / 2 s,  d' = 0,
/// each plus noise (of a: Singer's model),
/// with a point p of the body, its velocity v, and d_f, how far each face lies from p. z is the third of the `level`
/// axes, which are those of the ground in the world, and h the direction in which the box points. What brakes stands
/// at last. A body without heading, whose yaw is known for sure, does not turn or accelerate: noise moves it. That the
/// point is no special one, and that faces never seen are unknown, makes parts that come into view no motion: d
/// changes, and not p.
class BodyFilter {
 public:
  static constexpr int kStates = 15;
  // Where the parts of the state begin
  static constexpr int kVelocity = 3, kYaw = 6, kYawRate = 7, kAcceleration = 8, kFirstFace = 9;
  using Vector = Eigen::Matrix<double, kStates, 1>;
  using Matrix = Eigen::Matrix<double, kStates, kStates>;

  BodyFilter(const Vector& state, const Matrix& covariance, const Eigen::Matrix3d& level)
      : x_(state), P_(covariance), level_(level) {}

  [[nodiscard]] Eigen::Vector3d position() const { return x_.head<3>(); }              ///< p: m, world
  [[nodiscard]] Eigen::Vector3d velocity() const { return x_.segment<3>(kVelocity); }  ///< v: m/s, world
  [[nodiscard]] double yaw() const { return x_[kYaw]; }                                ///< rad, in the level axes
  [[nodiscard]] double yaw_rate() const { return x_[kYawRate]; }                       ///< rad/s
  [[nodiscard]] double acceleration() const { return x_[kAcceleration]; }              ///< m/s^2, ahead
  [[nodiscard]] double yaw_sigma() const;                                              ///< rad
  [[nodiscard]] double distance(Face face) const { return x_[index(face)]; }           ///< m, from p outwards
  [[nodiscard]] double variance(Face face) const { return P_(index(face), index(face)); }
  [[nodiscard]] double covariance(Face a, Face b) const { return P_(index(a), index(b)); }
  [[nodiscard]] Eigen::Matrix3d axes() const;  ///< columns: ahead, to the left, up; world
  [[nodiscard]] const Eigen::Matrix3d& level() const { return level_; }
  [[nodiscard]] const Vector& state() const { return x_; }
  [[nodiscard]] const Matrix& covariance() const { return P_; }

  /// W of `ClusterVelocity` for a sensor at `sensor_world`, and its covariance.
  [[nodiscard]] Eigen::Vector3d doppler_velocity(const Eigen::Vector3d& sensor_world) const;
  [[nodiscard]] Eigen::Matrix3d doppler_covariance(const Eigen::Vector3d& sensor_world) const;

  /// Velocity of the point `from_reference` away from p (m, box axes; 2.5 ahead), and its covariance: m/s, world.
  [[nodiscard]] Eigen::Vector3d velocity_at(const Eigen::Vector3d& from_reference) const;
  [[nodiscard]] Eigen::Matrix3d velocity_covariance_at(const Eigen::Vector3d& from_reference) const;

  /// How far outside of a face a point lies (m, world), and the standard deviation of what is known of that.
  [[nodiscard]] double beyond(Face face, const Eigen::Vector3d& point) const;
  [[nodiscard]] double beyond_sigma(Face face, const Eigen::Vector3d& point) const;

  /// The state `dt_s` seconds later (or earlier, with as much uncertainty).
  void predict(double dt_s, const MotionNoise& noise);

  // A correction returns the logarithm of its likelihood relative to that of a measurement without error from a known
  // state: 0 at best, lower when it surprises and when little had been known before. Measurements that surprise too
  // much are taken in with less weight.

  /// `seen` (m, world) lies on a face.
  double correct_face(Face face, const Eigen::Vector3d& seen, double variance);

  /// Nothing is known any more of where a face is.
  void forget_face(Face face, double variance);

  /// `seen` is p itself, up to an error of this variance along an axis of the box.
  double correct_position(int axis, const Eigen::Vector3d& seen, double variance);

  double correct_yaw(double yaw_rad, double variance);
  double correct_yaw_rate(double yaw_rate_rps, double variance);

  /// The body stands, but for this variance of the velocity, (m/s)^2.
  void stop(double variance);

  /// The middle of the body moves where the box points: no velocity to the left.
  double correct_sideslip(double variance);

  /// The Doppler of one scan, W and information in world axes. `floor` is the covariance of what the regression cannot
  /// know: errors all points share. `beam_sigma_mps`: the standard deviation of the mean of errors that differ from
  /// beam to beam; what is narrow seems to move across the line of sight by them.
  double correct_doppler(const ClusterVelocity& measured, const Eigen::Vector3d& sensor_world,
                         const Eigen::Matrix3d& floor, double beam_sigma_mps = 0.0);

  /// The same body with the box pointing backwards: what was ahead is behind.
  void turn_around();

  void set_level(const Eigen::Matrix3d& level) { level_ = level; }

  void state(StateArchive& archive);

 private:
  using Row = Eigen::Matrix<double, 1, kStates>;

  static constexpr int index(Face face) { return kFirstFace + static_cast<int>(face); }
  [[nodiscard]] Eigen::Vector3d up() const { return level_.col(2); }
  void move(double dt_s, const MotionNoise& noise);
  [[nodiscard]] double time_to_stop_s() const;
  [[nodiscard]] bool has_heading() const { return P_(kYaw, kYaw) > 0.0; }
  [[nodiscard]] Row face_jacobian(Face face, const Eigen::Vector3d& seen) const;
  [[nodiscard]] Eigen::Matrix<double, 3, kStates> doppler_jacobian(const Eigen::Vector3d& sensor_world) const;
  double correct(const Row& H, double residual, double variance);

  Vector x_;
  Matrix P_;
  Eigen::Matrix3d level_;
};

}  // namespace dynamic_icp::tracking
