// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/registration/sweep_motion.hpp"

#include <algorithm>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::registration {
namespace {

constexpr std::size_t kIntervals = 96;
constexpr std::size_t kBlock = 2048;
constexpr double kLeastInterval_s = 1e-12;  // what takes less is an instant

}  // namespace

Eigen::Matrix3d SweepMotion::rotation(double tau) const { return exp_so3(tau * omega + 0.5 * tau * tau * alpha); }

Eigen::Isometry3d SweepMotion::pose(double tau) const {
  Eigen::Isometry3d T_stamp_tau = Eigen::Isometry3d::Identity();
  if (tau == 0.0) {
    return T_stamp_tau;
  }
  T_stamp_tau.linear() = rotation(tau);
  const Eigen::Vector3d middle = rotation(0.5 * tau) * velocity_at(0.5 * tau);
  T_stamp_tau.translation() = tau / 6.0 * (velocity + 4.0 * middle + T_stamp_tau.linear() * velocity_at(tau));
  return T_stamp_tau;
}

TimeSpan time_span(const Scan& scan) {
  if (scan.times().empty()) {
    return {};
  }
  const auto [first, last] = std::ranges::minmax(scan.times());
  return {first, last};
}

SweepUndone::SweepUndone(const SweepMotion& sweep, const TimeSpan& span) : first_(span.first) {
  const double interval = (span.last - span.first) / static_cast<double>(kIntervals);
  per_second_ = interval > kLeastInterval_s ? 1.0 / interval : 0.0;
  knots_.resize(interval > kLeastInterval_s ? kIntervals + 1 : 1);
  for (std::size_t k = 0; k < knots_.size(); ++k) {
    const double tau = first_ + static_cast<double>(k) * interval;
    knots_[k] = {tau, sweep.pose(tau), sweep.omega + tau * sweep.alpha, sweep.velocity_at(tau)};
  }
}

std::vector<Eigen::Vector3d> points_at_stamp(const Scan& scan, const SweepMotion& sweep, const Workers& workers) {
  std::vector<Eigen::Vector3d> points = scan.points();
  const SweepUndone undone(sweep, time_span(scan));
  workers.for_each(scan.times().size(), kBlock,
                   [&](std::size_t row) { points[row] = undone.at_stamp(points[row], scan.times()[row]); });
  return points;
}

Scan undo_sweep(Scan scan, const SweepMotion& sweep, const Workers& workers) {
  const SweepUndone undone(sweep, time_span(scan));
  workers.for_each(scan.times().size(), kBlock, [&](std::size_t row) {
    const Eigen::Vector3d& point = scan.points()[row];
    scan.displace(row, undone.at_stamp(point, scan.times()[row]) - point);
  });
  return scan;
}

}  // namespace dynamic_icp::registration
