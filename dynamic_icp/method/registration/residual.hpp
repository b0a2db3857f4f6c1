// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::registration {

/// One residual and its derivative by the left perturbation T <- exp(xi) T, xi = [omega (rad); rho (m)].
struct Residual {
  double value = 0.0;
  Vector6d jacobian = Vector6d::Zero();  ///< d value / d [omega; rho]
};

/// Three residuals that belong together.
struct VectorResidual {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 3, 6> jacobian = Eigen::Matrix<double, 3, 6>::Zero();  ///< d value / d [omega; rho]
};

}  // namespace dynamic_icp::registration
