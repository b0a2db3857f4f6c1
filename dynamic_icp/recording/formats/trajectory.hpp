// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/stamp.hpp"

namespace dynamic_icp::formats {

/// Where the sensor was at one time: p_world = T_world_sensor * p_sensor.
struct StampedPose {
  Stamp stamp;
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();
};

/// Poses in the order of their strictly increasing stamps.
using Trajectory = std::vector<StampedPose>;

}  // namespace dynamic_icp::formats
