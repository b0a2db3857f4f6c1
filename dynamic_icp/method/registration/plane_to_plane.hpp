// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace dynamic_icp::registration {

/// The information matrix of Generalized ICP for the residual of point_to_point.hpp: each point is taken as drawn from
/// a piece of plane, with variance `thickness` across it and 1 along it (relative to each other),
///   C = I - (1 - thickness) n n^T,   information = (C_target + R C_source R^T)^-1.
/// Normals are unit vectors in the target frame, the source's turned by R; a zero vector stands for an unknown normal
/// and gives C = I.
inline Eigen::Matrix3d plane_to_plane_information(const Eigen::Vector3d& normal_source,
                                                  const Eigen::Vector3d& normal_target, double thickness) {
  const Eigen::Matrix3d covariance =
      2.0 * Eigen::Matrix3d::Identity() -
      (1.0 - thickness) * (normal_source * normal_source.transpose() + normal_target * normal_target.transpose());
  return covariance.inverse();
}

}  // namespace dynamic_icp::registration
