// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/recording/diagnosis/evidence.hpp"

// How far the velocities that the sensors of a rig show by themselves are from one motion, v_k = v + omega x l_k.
namespace dynamic_icp::diagnosis {

/// Rotations of the velocities of sensors about the origin of the scan, one each: as if they were mounted otherwise.
using Remounting = std::vector<Eigen::Matrix3d>;

/// A velocity in one look: by a sensor, or the direction of travel by other means.
struct VelocityEstimate {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();    ///< m/s, in the axes of the scan
  Eigen::Vector3d lever_arm = Eigen::Vector3d::Zero();   ///< m, where it is in the scan
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< (m/s)^2, of what differs from stretch to stretch
  Eigen::Matrix3d lasting = Eigen::Matrix3d::Zero();     ///< (m/s)^2, of what may be the same in all
  bool is_known = false;
};

/// All that one look says of the motion.
struct RigLook {
  std::size_t stretch = 0;
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();  ///< rad/s
  double omega_sigma = 0.0;                         ///< rad/s
  bool has_truth = false;                           ///< the direction of travel is that of the ground truth
  std::vector<VelocityEstimate> estimates;  ///< the sensors, then the ground truth or else that vehicles drive ahead
};

/// Looks fast enough to compare directions. `sensors`: how many there are.
std::vector<RigLook> rig_looks_of(const Evidence& evidence, std::size_t sensors);

/// From the direction in which estimate `from` has estimate `to` move to the one in which that moves by itself.
struct Offset {
  bool is_known = false;      ///< both know velocities in the same looks
  double left_rad = 0.0;      ///< positive: to the left of the direction of travel, seen from +z of the scan
  double up_rad = 0.0;        ///< positive: towards +z
  double left_limit_rad = 0;  ///< a larger one is no chance and no error of the Doppler
  double up_limit_rad = 0;
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< of the last look: columns ahead, left, up in scan axes

  /// Beyond what statistics and the errors of sensors allow.
  [[nodiscard]] bool contradicts() const;
  /// The whole angle.
  [[nodiscard]] double angle_rad() const;
  /// Limit of the larger part, for words.
  [[nodiscard]] double limit_rad() const;
};

Offset offset(const std::vector<RigLook>& rig_looks, std::size_t from, std::size_t to, const Remounting& remounting);

}  // namespace dynamic_icp::diagnosis
