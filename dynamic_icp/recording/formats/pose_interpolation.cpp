// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/pose_interpolation.hpp"

#include <algorithm>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::formats {

Eigen::Isometry3d interpolate(const StampedPose& before, const StampedPose& after, Stamp stamp) {
  const double share = seconds_between(before.stamp, stamp) / seconds_between(before.stamp, after.stamp);
  const Eigen::Isometry3d& a = before.T_world_sensor;
  const Eigen::Isometry3d& b = after.T_world_sensor;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = a.linear() * exp_so3(share * log_so3(a.linear().transpose() * b.linear()));
  T.translation() = a.translation() + share * (b.translation() - a.translation());
  return T;
}

std::optional<Eigen::Isometry3d> pose_at(const Trajectory& trajectory, Stamp stamp, double max_gap_s) {
  if (trajectory.size() < 2) {
    return std::nullopt;
  }
  auto after = std::lower_bound(trajectory.begin(), trajectory.end(), stamp,
                                [](const StampedPose& pose, Stamp s) { return pose.stamp < s; });
  after = std::clamp(after, trajectory.begin() + 1, trajectory.end() - 1);
  const auto before = after - 1;
  const double span_s = seconds_between(before->stamp, after->stamp);
  const double since_s = seconds_between(before->stamp, stamp);
  if (!(span_s > 0.0) || span_s > max_gap_s || since_s < 0.0 || since_s > 2.0 * span_s) {
    return std::nullopt;
  }
  return interpolate(*before, *after, stamp);
}

}  // namespace dynamic_icp::formats
