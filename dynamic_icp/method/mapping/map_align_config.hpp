// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/base/config_field.hpp"

namespace dynamic_icp::mapping {

struct MapAlignConfig {
  int max_iterations = 20;
  double min_sigma_m = 0.005;        ///< smallest standard deviation of a point from its plane
  double model_sigma_m = 0.003;      ///< of a patch from a plane: common to all points on it
  double kernel = 3.0;               ///< Tukey: points beyond so many standard deviations have no weight
  double max_gate_m = 4.0;           ///< largest Tukey cutoff while the start is uncertain
  double rotation_step_rad = 1e-6;   ///< converged when a step is shorter than this
  double translation_step_m = 1e-5;  ///< and this
};

ConfigFields fields(MapAlignConfig& config);

}  // namespace dynamic_icp::mapping
