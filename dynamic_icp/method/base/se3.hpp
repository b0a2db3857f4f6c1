// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "dynamic_icp/method/base/eigen_layout.hpp"

namespace dynamic_icp {

// Rigid motions. One convention holds everywhere:
//   - a pose is an Eigen::Isometry3d named by its frames, T_target_source: p_target = T_target_source * p_source;
//   - a tangent vector is xi = [omega; rho], rotation (rad) first, then translation (m);
//   - a perturbation acts from the left: T <- exp_se3(xi) * T, so xi is expressed in the target frame.

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// The matrix [v]_x with [v]_x w = v x w.
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

/// Rotation by |omega| radians about omega; exact for tiny angles.
Eigen::Matrix3d exp_so3(const Eigen::Vector3d& omega);

/// The rotation vector of R, length in [0, pi]; exp_so3(log_so3(R)) = R, also near pi.
Eigen::Vector3d log_so3(const Eigen::Matrix3d& R);

/// The right Jacobian J of SO(3): exp_so3(omega + d) = exp_so3(omega) exp_so3(J d) to first order in d.
Eigen::Matrix3d right_jacobian_so3(const Eigen::Vector3d& omega);

/// The rigid motion of the constant twist xi = [omega; rho] over unit time.
Eigen::Isometry3d exp_se3(const Vector6d& xi);

/// The inverse of `exp_se3`.
Vector6d log_se3(const Eigen::Isometry3d& T);

/// The angle of the rotation R in radians, in [0, pi]; accurate for tiny angles as well as near pi.
double rotation_angle(const Eigen::Matrix3d& R);

}  // namespace dynamic_icp
