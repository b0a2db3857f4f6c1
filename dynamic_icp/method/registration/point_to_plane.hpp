// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/registration/residual.hpp"

namespace dynamic_icp::registration {

/// The geometry residual of the paper, Eq. (12): r_g = n_j . (R p_i + t - q_j), metres.
/// `q_source` is the moved source point R p_i + t, `q` and `normal` the target point and its normal, all in the target
/// frame. Jacobian: [q_source x n; n].
inline Residual point_to_plane(const Eigen::Vector3d& q_source, const Eigen::Vector3d& q,
                               const Eigen::Vector3d& normal) {
  Residual residual;
  residual.value = normal.dot(q_source - q);
  residual.jacobian << q_source.cross(normal), normal;
  return residual;
}

}  // namespace dynamic_icp::registration
