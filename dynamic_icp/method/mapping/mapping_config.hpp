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

}  // namespace dynamic_icp::mapping
