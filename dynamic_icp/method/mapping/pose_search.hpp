// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/mapping/plane_map.hpp"
#include "dynamic_icp/method/motion/sweep_motion.hpp"

namespace dynamic_icp::mapping {

/// What is known of a scan before its points are compared with the map.
struct PosePrior {
  Eigen::Matrix3d R_map_sensor = Eigen::Matrix3d::Identity();  ///< at the stamp
  double rotation_sigma_rad = 0.0;                             ///< about each axis
  /// The position at the stamp: t = displacement_fixed + R displacement_rotated. The second part comes from the
  /// velocity of this very scan, which turns with it.
  Eigen::Vector3d displacement_fixed = Eigen::Vector3d::Zero();    ///< m, map axes, from the map's origin
  Eigen::Vector3d displacement_rotated = Eigen::Vector3d::Zero();  ///< m, sensor axes at the stamp
  double position_sigma_m = 0.0;                                   ///< along each axis
  motion::SweepMotion sweep;                                       ///< by which the scan is deskewed
};

/// Where a scan stands in the map.
struct FoundPose {
  Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();  ///< at the stamp
  std::size_t on_planes = 0;                                       ///< points with a patch of the map
  double matched = 0.0;                                            ///< sum of the kernel's weights: points that agree
  bool diverged = false;  ///< a step was not finite or left the reach of any scan; the pose is that of the step before
};

/// Finds the rotation of a scan of static points in a map where little is known of it: some points are aligned from
/// rotations within the reach of the prior, all points from the one that most of them agree with. Each alignment
/// minimises over rotation and position
///   sum_i w_i rho(e_i) + |prior|^2,   e_i = n . (T_map_sensor T_stamp_tau(i) p_i - mean)
/// by Gauss-Newton with Tukey's rho, whose cutoff narrows with each step.
FoundPose search_pose(const Scan& scan, const PlaneMap& map, const PosePrior& prior, const Workers& workers);

}  // namespace dynamic_icp::mapping
