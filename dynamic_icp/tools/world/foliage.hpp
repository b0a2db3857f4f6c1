// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace dynamic_icp::world {

/// Where wind has moved a leaf and how fast.
struct LeafMotion {
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      ///< m/s, its exact derivative
};

/// The motion of the leaf at `position` (m) in a light wind: three waves that run through the foliage with 0.5, 1.1 and
/// 2.3 Hz and lengths of 1 to 5 m, each along its own axis. `amplitude_m` is that of one sine of the same power, over
/// all axes.
LeafMotion leaf_motion(const Eigen::Vector3d& position, double time_s, double amplitude_m);

}  // namespace dynamic_icp::world
