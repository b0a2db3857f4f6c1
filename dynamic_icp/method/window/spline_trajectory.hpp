// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::window {

/// Slices of a knot interval within which the sensor moves straight on: what is asked for each of many points is asked
/// for the slices.
inline constexpr double kSlices = 8.0;

/// The sensor at one time, and how that depends on the four coefficients around it.
struct TrajectoryPoint {
  std::size_t first = 0;                               ///< of the four coefficients
  std::array<double, 4> weight{};                      ///< of each coefficient
  std::array<double, 4> slope{};                       ///< d weight / dt, 1/s
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();     ///< R_reference_sensor
  Eigen::Vector3d p = Eigen::Vector3d::Zero();         ///< m, position in the reference frame
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();     ///< right Jacobian of SO(3) at phi: R(phi + d) = R exp(J d)
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s, sensor axes: R^T dp/dt
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();     ///< rad/s, sensor axes: J dphi/dt

  /// Where a point is in the reference frame that was seen at x (sensor axes) a moment later, by a straight step.
  [[nodiscard]] Eigen::Vector3d place(const Eigen::Vector3d& x, double step_s) const;
};

/// The motion of the sensor in continuous time: rotation vector and position relative to a reference pose,
///   T_map_sensor(t) = T_map_reference (exp phi(t), p(t)),   [phi; p](t) = sum_j weight_j(t) c_j,
/// a uniform cubic B-spline. Its third derivative is constant between two knots. The reference is moved along with the
/// sensor, so phi stays small.
class SplineTrajectory {
 public:
  explicit SplineTrajectory(double knot_spacing_s) : h_(knot_spacing_s) {}

  /// Begins anew at `time_s` with the given pose and constant velocities (sensor axes), until `until_s`.
  void begin(double time_s, double until_s, const Eigen::Isometry3d& T_map_sensor, const Eigen::Vector3d& velocity,
             const Eigen::Vector3d& omega);

  /// Lays all coefficients anew: a constant twist from the pose at `time_s`.
  void set_constant_twist(double time_s, const Eigen::Vector3d& velocity, const Eigen::Vector3d& omega);

  /// Appends coefficients until `until_s` is covered: the motion of the last `memory_s` goes on evenly. How many.
  std::size_t extend(double until_s, double memory_s);

  /// Forgets all that concerns only times before `time_s`: how many coefficients.
  std::size_t drop_before(double time_s);

  /// Makes the pose at `time_s` the reference. For each coefficient the 6 x 6 matrix A with d c_before = A d c_after.
  std::vector<Matrix6d> move_reference(double time_s);

  [[nodiscard]] TrajectoryPoint at(double time_s) const;

  /// Where the last knot interval ends: as the sensor moved last.
  [[nodiscard]] TrajectoryPoint at_end() const { return at(interval_begin(c_.size() - 3)); }
  [[nodiscard]] Eigen::Isometry3d pose(double time_s) const;  ///< T_map_sensor

  [[nodiscard]] const Eigen::Isometry3d& reference() const { return T_map_reference_; }
  [[nodiscard]] std::vector<Vector6d>& coefficients() { return c_; }
  [[nodiscard]] const std::vector<Vector6d>& coefficients() const { return c_; }
  /// The part of each coefficient that is vibration.
  [[nodiscard]] std::vector<Vector6d>& vibration() { return v_; }
  [[nodiscard]] const std::vector<Vector6d>& vibration() const { return v_; }
  [[nodiscard]] double knot_spacing() const { return h_; }

  /// The interval between knots that a time lies in: the first of its coefficients.
  [[nodiscard]] std::size_t interval(double time_s) const;
  [[nodiscard]] double interval_begin(std::size_t interval) const;

  void state(StateArchive& archive);

  /// Whether it holds these times, but for the error of stamps.
  [[nodiscard]] bool spans(double from_s, double to_s) const;

 private:
  double h_;
  long first_ = 0;  ///< number of the interval that the first coefficient begins
  Eigen::Isometry3d T_map_reference_ = Eigen::Isometry3d::Identity();
  std::vector<Vector6d> c_;  ///< [phi (rad); p (m)]
  std::vector<Vector6d> v_;
};

/// Velocity and angular velocity of a trajectory at even times, and linear between them: for what is asked for each of
/// many points.
class SampledMotion {
 public:
  SampledMotion(const SplineTrajectory& trajectory, double first_s, double last_s);

  /// m/s and rad/s, sensor axes. Times outside count as the nearest inside.
  [[nodiscard]] Eigen::Vector3d velocity(double time_s) const { return between(velocity_, time_s); }
  [[nodiscard]] Eigen::Vector3d omega(double time_s) const { return between(omega_, time_s); }

  /// Whether velocity and angular velocity are nearly those of another motion, sampled at nearly the same times.
  [[nodiscard]] bool is_near(const SampledMotion& other, double velocity_mps, double omega_rad_s) const;

 private:
  [[nodiscard]] Eigen::Vector3d between(const std::vector<Eigen::Vector3d>& samples, double time_s) const {
    const double x = std::clamp(per_step_ * (time_s - first_s_), 0.0, static_cast<double>(samples.size() - 1));
    const auto k = static_cast<std::size_t>(x);
    const std::size_t next = std::min(samples.size() - 1, k + 1);
    const double share = x - static_cast<double>(k);
    return (1.0 - share) * samples[k] + share * samples[next];
  }

  double first_s_;
  double per_step_;  ///< 1/s
  std::vector<Eigen::Vector3d> velocity_;
  std::vector<Eigen::Vector3d> omega_;
};

}  // namespace dynamic_icp::window
