// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/true_motion.hpp"

#include <algorithm>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::diagnosis {
namespace {

constexpr double kMostGap_s = 0.5;

}  // namespace

std::optional<Eigen::Isometry3d> pose_at(const formats::Trajectory& truth, Stamp stamp) {
  if (truth.size() < 2) {
    return std::nullopt;
  }
  auto after = std::lower_bound(truth.begin(), truth.end(), stamp,
                                [](const formats::StampedPose& pose, Stamp s) { return pose.stamp < s; });
  after = std::clamp(after, truth.begin() + 1, truth.end() - 1);
  const auto before = after - 1;
  const double span_s = seconds_between(before->stamp, after->stamp);
  const double since_s = seconds_between(before->stamp, stamp);
  if (!(span_s > 0.0) || span_s > kMostGap_s || since_s < 0.0 || since_s > 2.0 * span_s) {
    return std::nullopt;
  }
  const double share = since_s / span_s;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = before->T_world_sensor.translation() +
                       share * (after->T_world_sensor.translation() - before->T_world_sensor.translation());
  const Eigen::Matrix3d turn = before->T_world_sensor.linear().transpose() * after->T_world_sensor.linear();
  pose.linear() = before->T_world_sensor.linear() * exp_so3(share * log_so3(turn));
  return pose;
}

}  // namespace dynamic_icp::diagnosis
