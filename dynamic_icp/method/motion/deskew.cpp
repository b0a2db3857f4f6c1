// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/motion/deskew.hpp"

#include <algorithm>
#include <utility>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::motion {
namespace {

constexpr std::size_t kIntervals = 96;
constexpr std::size_t kDeskewBlock = 2048;
constexpr double kMinInterval_s = 1e-12;  // what takes less is an instant

}  // namespace

TimeSpan time_span(const Scan& scan) {
  if (scan.times().empty()) {
    return {};
  }
  const auto [first, last] = std::ranges::minmax(scan.times());
  return {first, last};
}

Deskewer::Deskewer(const SweepMotion& sweep, const TimeSpan& span) : first_(span.first) {
  const double interval = (span.last - span.first) / static_cast<double>(kIntervals);
  per_second_ = interval > kMinInterval_s ? 1.0 / interval : 0.0;
  knots_.resize(interval > kMinInterval_s ? kIntervals + 1 : 1);
  for (std::size_t k = 0; k < knots_.size(); ++k) {
    const double tau = first_ + static_cast<double>(k) * interval;
    knots_[k] = {tau, sweep.pose(tau), sweep.omega + tau * sweep.alpha, sweep.velocity_at(tau)};
  }
}

std::vector<Eigen::Vector3d> deskewed_points(const Scan& scan, const SweepMotion& sweep, const Workers& workers) {
  std::vector<Eigen::Vector3d> points = scan.points();
  const Deskewer deskewer(sweep, time_span(scan));
  workers.for_each(scan.times().size(), kDeskewBlock,
                   [&](std::size_t row) { points[row] = deskewer.at_stamp(points[row], scan.times()[row]); });
  return points;
}

Scan deskew(Scan scan, const SweepMotion& sweep, const Workers& workers) {
  const TimeSpan span = time_span(scan);
  return deskew(std::move(scan), sweep, span, workers);
}

Scan deskew(Scan scan, const SweepMotion& sweep, const TimeSpan& plausible, const Workers& workers) {
  const Deskewer deskewer(sweep, plausible);
  workers.for_each(scan.times().size(), kDeskewBlock, [&](std::size_t row) {
    const Eigen::Vector3d& point = scan.points()[row];
    const double tau = std::clamp(scan.times()[row], plausible.first, plausible.last);
    scan.displace(row, deskewer.at_stamp(point, tau) - point);
  });
  return scan;
}

Scan deskew_to_middle(const Scan& scan, const Eigen::Isometry3d& T_begin_end) {
  Scan result = scan;
  const TimeSpan span = time_span(scan);
  const double duration_s = span.last - span.first;
  if (!(duration_s > 0.0)) {
    return result;
  }
  const Vector6d twist = log_se3(T_begin_end);
  for (std::size_t row = 0; row < scan.size(); ++row) {
    const double s = (scan.times()[row] - span.first) / duration_s;
    const Eigen::Vector3d& point = scan.points()[row];
    result.displace(row, exp_se3((s - 0.5) * twist) * point - point);
  }
  return result;
}

}  // namespace dynamic_icp::motion
