// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/adaptive_threshold.hpp"

#include <cmath>

#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"

namespace dynamic_icp::odometry {

double point_displacement(const Eigen::Isometry3d& T, double max_range_m) {
  return T.translation().norm() + 2.0 * max_range_m * std::sin(0.5 * rotation_angle(T.linear()));
}

void AdaptiveThreshold::observe(const Eigen::Isometry3d& T_predicted_registered, double distance_from_first_m) {
  has_moved_ = distance_from_first_m > 5.0 * min_motion_m_;
  const double deviation_m = point_displacement(T_predicted_registered, max_range_m_);
  if (has_moved_ && deviation_m > min_motion_m_) {
    sum_of_squares_ += deviation_m * deviation_m;
    ++count_;
  }
}

double AdaptiveThreshold::sigma_m() const {
  return has_moved_ && count_ > 0 ? std::sqrt(sum_of_squares_ / static_cast<double>(count_)) : initial_m_;
}

void AdaptiveThreshold::state(StateArchive& archive) { archive(has_moved_, sum_of_squares_, count_); }

}  // namespace dynamic_icp::odometry
