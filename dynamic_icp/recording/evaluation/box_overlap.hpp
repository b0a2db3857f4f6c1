// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

namespace dynamic_icp::evaluation {

/// A box with its x axis ahead.
struct Box {
  Eigen::Isometry3d T_sensor_box = Eigen::Isometry3d::Identity();  ///< its centre and axes
  Eigen::Vector3d size = Eigen::Vector3d::Zero();                  ///< m, edges along its axes
};

/// Volume that two boxes have in common, m^3, however they are turned.
double common_volume(const Box& a, const Box& b);

/// That over the volume of both together, in [0, 1]; 0 for boxes without volume.
double intersection_over_union(const Box& a, const Box& b);

}  // namespace dynamic_icp::evaluation
