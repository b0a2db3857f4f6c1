// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/registration/residual.hpp"

namespace dynamic_icp::registration {

/// The residual of point-to-point ICP: e = R p_i + t - q_j, metres. `q_source` is the moved source point R p_i + t, `q`
/// the target point, both in the target frame. Jacobian: [-[q_source]_x, I].
inline VectorResidual point_to_point(const Eigen::Vector3d& q_source, const Eigen::Vector3d& q) {
  VectorResidual residual;
  residual.value = q_source - q;
  residual.jacobian << -skew(q_source), Eigen::Matrix3d::Identity();
  return residual;
}

}  // namespace dynamic_icp::registration
