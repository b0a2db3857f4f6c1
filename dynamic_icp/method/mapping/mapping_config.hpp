// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/mapping/plane.hpp"

namespace dynamic_icp::mapping {

/// Of the local map.
struct PlaneMapConfig {
  double finest_cell_m = 0.5;  ///< edge of the cells of the finest level; each level above has twice the edge
  int levels = 3;
  double memory_scans = 10.0;  ///< the weight of a point falls to 1/e in about so many scans; 0: only the last scan
  double max_range_m = 200.0;  ///< cells farther from the sensor are dropped
  PlaneRule plane;
};

ConfigFields fields(PlaneMapConfig& config);

/// Of the alignment of a scan to the map.
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
