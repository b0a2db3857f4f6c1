// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/messages/rigid_pose.hpp"

#include <cmath>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::messages {

bool is_rotation(const Eigen::Quaterniond& quaternion) {
  constexpr double kTolerance = 0.1;
  return std::abs(quaternion.norm() - 1.0) <= kTolerance;  // false for NaN
}

Eigen::Isometry3d rigid_pose(const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation,
                             const std::string& origin, std::string_view field) {
  if (!position.allFinite() || !is_rotation(orientation)) {
    throw DataError(
        fmt::format("{}: {} is position ({}, {}, {}), quaternion x, y, z, w ({}, {}, {}, {}), expected finite "
                    "numbers and a quaternion of length 1",
                    origin, field, position.x(), position.y(), position.z(), orientation.x(), orientation.y(),
                    orientation.z(), orientation.w()));
  }
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = orientation.normalized().toRotationMatrix();
  T.translation() = position;
  return T;
}

}  // namespace dynamic_icp::messages
