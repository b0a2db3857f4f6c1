// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/base/config_field.hpp"

namespace dynamic_icp::odometry {

/// The settings of KISS-ICP with the defaults of its authors' releases 0.2.10 to 1.2.0.
struct KissConfig {
  bool deskew = false;
  double min_range_m = 5.0;
  double max_range_m = 100.0;
  double voxel_size_m = 1.0;  ///< published: a hundredth of max_range_m
  int max_points_per_voxel = 20;
  double initial_threshold_m = 2.0;
  double min_motion_m = 0.1;
  int max_iterations = 500;
  double min_step = 1e-4;  ///< of the norm of [omega (rad); rho (m)]
};

ConfigFields fields(KissConfig& config);

/// Throws UsageError naming values that do not go together; each is taken to be in its own range.
void check(const KissConfig& config);

}  // namespace dynamic_icp::odometry
