// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/registration/residual.hpp"

namespace dynamic_icp::registration {

/// The Doppler residual of the paper, Eq. (13): r_v = u_j . R (s_i u_i) - s_j, m/s.
/// `ray_target` is the Doppler ray of the source turned into the target frame, R (s_i u_i); `direction` and `doppler`
/// are u_j and s_j of the target point. Jacobian: [ray_target x u_j; 0]. It does not depend on the translation, so
/// three columns are exactly zero and the term says nothing about where the sensor went, only how it turned. It also
/// vanishes where the two lines of sight agree: at small rotations the constraint is weak.
inline Residual doppler_rotation(const Eigen::Vector3d& ray_target, const Eigen::Vector3d& direction, double doppler) {
  Residual residual;
  residual.value = direction.dot(ray_target) - doppler;
  residual.jacobian << ray_target.cross(direction), Eigen::Vector3d::Zero();
  return residual;
}

}  // namespace dynamic_icp::registration
