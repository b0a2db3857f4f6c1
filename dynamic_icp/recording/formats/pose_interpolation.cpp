// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/pose_interpolation.hpp"

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

}  // namespace dynamic_icp::formats
