// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/base/se3.hpp"

namespace dynamic_icp::registration {

/// A residual of one correspondence and its derivative by a left perturbation exp_se3(xi) * T_target_source.
struct Residual {
  double value = 0.0;
  Vector6d jacobian = Vector6d::Zero();  ///< d value / d [omega; rho]
};

}  // namespace dynamic_icp::registration
