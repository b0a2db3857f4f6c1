// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/ego_motion/ego_velocity.hpp"

namespace dynamic_icp::ego_motion {

struct DopplerRegressionConfig {
  double huber_delta_mps = 0.3;
  int max_iterations = 50;
  double step_tolerance_mps = 1e-5;
};

ConfigFields fields(DopplerRegressionConfig& config);

/// Robust regression of the paper's Eq. (3): min_v sum rho(s_i + u_i . v) with the Huber loss, from the prior (m/s,
/// sensor frame), which is kept along directions that no line of sight observes; see
/// estimation/velocity_regression.hpp.
EgoVelocity estimate_velocity(const Scan& scan, const Eigen::Vector3d& prior_sensor,
                              const DopplerRegressionConfig& config, const Workers& workers);

}  // namespace dynamic_icp::ego_motion
