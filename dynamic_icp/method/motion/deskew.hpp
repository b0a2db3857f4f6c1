// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/motion/sweep_motion.hpp"

namespace dynamic_icp::motion {

/// The earliest and the latest time of some points, s after the stamp.
struct TimeSpan {
  double first = 0.0;
  double last = 0.0;
};

/// Of all points of a scan; of one without times its stamp.
TimeSpan time_span(const Scan& scan);

/// Deskews many points: the poses at a few times, and from the nearest of them a straight step. Exact to the
/// square of the rotation within half an interval, far below a tenth of a millimetre.
class Deskewer {
 public:
  /// For points with times within this span.
  Deskewer(const SweepMotion& sweep, const TimeSpan& span);

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
Scan deskew(Scan scan, const SweepMotion& sweep, const Workers& workers);

/// Deskewing where times may be wrong: points beyond `plausible` count as measured at its nearer end.
Scan deskew(Scan scan, const SweepMotion& sweep, const TimeSpan& plausible, const Workers& workers);

/// Only the points of a deskewed scan, m, sensor axes at the stamp.
std::vector<Eigen::Vector3d> deskewed_points(const Scan& scan, const SweepMotion& sweep, const Workers& workers);

/// Deskewing as in KISS-ICP, by a constant twist and to the middle of the scan:
///   p_i <- exp((s_i - 1/2) log(T_begin_end)) p_i,
/// where s_i is the time of the point over the duration of the scan, 0 for the earliest point and 1 for the latest.
/// `T_begin_end` is the pose of the sensor at the end of the sweep in the frame at its begin. Lines of sight and
/// Doppler stay as measured. A scan without times, or with all times equal, is returned as it is.
Scan deskew_to_middle(const Scan& scan, const Eigen::Isometry3d& T_begin_end);

}  // namespace dynamic_icp::motion
