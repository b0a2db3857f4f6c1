// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"

namespace dynamic_icp::registration {

/// How the sensor moves while it takes a scan: velocity and rate of turn, both changing linearly. All vectors are in
/// the axes of the sensor, which turn with it; tau is in s after the stamp of the scan.
struct SweepMotion {
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();         ///< rad/s at the stamp
  Eigen::Vector3d alpha = Eigen::Vector3d::Zero();         ///< rad/s^2: omega(tau) = omega + alpha tau
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      ///< m/s over ground at the stamp
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< m/s^2: v(tau) = velocity + acceleration tau

  /// R_stamp_tau = exp([omega tau + alpha tau^2 / 2]x); the turns of a scan are small enough to add up like vectors.
  [[nodiscard]] Eigen::Matrix3d rotation(double tau) const;

  /// v(tau) in the axes at tau, m/s.
  [[nodiscard]] Eigen::Vector3d velocity_at(double tau) const { return velocity + tau * acceleration; }

  /// T_stamp_tau: moves a point measured at tau to where it would have been measured at the stamp. The displacement is
  /// the integral of R_stamp_tau v(tau) by Simpson's rule.
  [[nodiscard]] Eigen::Isometry3d pose(double tau) const;
};

/// The earliest and the latest time of some points, s after the stamp.
struct TimeSpan {
  double first = 0.0;
  double last = 0.0;
};

/// Of all points of a scan; of one without times its stamp.
TimeSpan time_span(const Scan& scan);

/// Undoes a sweep for many points: the poses at a few times, and from the nearest of them a straight step. Exact to the
/// square of the turn within half an interval, far below a tenth of a millimetre.
class SweepUndone {
 public:
  /// For points with times within this span.
  SweepUndone(const SweepMotion& sweep, const TimeSpan& span);

  /// Where the point, measured at tau, would have been measured at the stamp.
  [[nodiscard]] Eigen::Vector3d at_stamp(const Eigen::Vector3d& point, double tau) const {
    const Knot& knot = knots_[static_cast<std::size_t>((tau - first_) * per_second_ + 0.5)];
    const double step = tau - knot.tau;
    return knot.T_stamp_tau * Eigen::Vector3d(point + step * (knot.omega.cross(point) + knot.velocity));
  }

 private:
  struct Knot {
    double tau = 0.0;
    Eigen::Isometry3d T_stamp_tau = Eigen::Isometry3d::Identity();
    Eigen::Vector3d omega = Eigen::Vector3d::Zero();
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  };

  double first_ = 0.0;
  double per_second_ = 0.0;
  std::vector<Knot> knots_;
};

/// The scan with all points where they would have been measured at the stamp. Lines of sight, Doppler and times stay as
/// measured; a scan without times is returned as it is. To change a scan in its place, move it in and out.
Scan undo_sweep(Scan scan, const SweepMotion& sweep, const Workers& workers);

/// Only the points of it, m, sensor axes at the stamp.
std::vector<Eigen::Vector3d> points_at_stamp(const Scan& scan, const SweepMotion& sweep, const Workers& workers);

}  // namespace dynamic_icp::registration
