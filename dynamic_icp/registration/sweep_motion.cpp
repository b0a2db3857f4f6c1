// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/registration/sweep_motion.hpp"

#include <algorithm>

#include "dynamic_icp/base/se3.hpp"

namespace dynamic_icp::registration {
namespace {

constexpr std::size_t kIntervals = 128;

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

SweepUndone::SweepUndone(const SweepMotion& sweep, const std::vector<double>& times) {
  double last = 0.0;
  if (!times.empty()) {
    const auto [low, high] = std::minmax_element(times.begin(), times.end());
    first_ = *low;
    last = *high;
  }
  const double interval = (last - first_) / static_cast<double>(kIntervals);
  per_second_ = interval > 0.0 ? 1.0 / interval : 0.0;
  knots_.resize(interval > 0.0 ? kIntervals + 1 : 1);
  for (std::size_t k = 0; k < knots_.size(); ++k) {
    const double tau = first_ + static_cast<double>(k) * interval;
    knots_[k] = {tau, sweep.pose(tau), sweep.omega + tau * sweep.alpha, sweep.velocity_at(tau)};
  }
}

Scan undo_sweep(const Scan& scan, const SweepMotion& sweep) {
  Scan result = scan;
  const SweepUndone undone(sweep, scan.times());
  for (std::size_t row = 0; row < scan.times().size(); ++row) {
    const Eigen::Vector3d& point = scan.points()[row];
    result.displace(row, undone.at_stamp(point, scan.times()[row]) - point);
  }
  return result;
}

}  // namespace dynamic_icp::registration
