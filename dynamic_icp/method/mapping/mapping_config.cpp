// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/mapping/mapping_config.hpp"

namespace dynamic_icp::mapping {

ConfigFields fields(PlaneMapConfig& config) {
  ConfigFields all = {
      {"finest_cell_m", &config.finest_cell_m, 0.05, 10.0, "m",
       "edge of the smallest cells of the local map; each level above has twice the edge"},
      {"levels", &config.levels, 1, 6, "", "sizes of cells; the largest whose points lie in a plane is used"},
      {"memory_scans", &config.memory_scans, 0.0, 1e6, "",
       "after about so many scans a point counts 1/e; 0 keeps the last scan only"},
      {"max_range_m", &config.max_range_m, 1.0, 1e4, "m", "cells of the local map farther from the sensor are dropped"},
  };
  append_fields(all, "plane", fields(config.plane));
  return all;
}

}  // namespace dynamic_icp::mapping
