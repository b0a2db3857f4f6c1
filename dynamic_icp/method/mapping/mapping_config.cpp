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

ConfigFields fields(MapAlignConfig& config) {
  return {
      {"max_iterations", &config.max_iterations, 1, 1000, "",
       "maximum number of steps of the alignment to the local map"},
      {"min_sigma_m", &config.min_sigma_m, 1e-4, 1.0, "m", "smallest standard deviation of a point from its plane"},
      {"model_sigma_m", &config.model_sigma_m, 0.0, 1.0, "m",
       "standard deviation of patches of surface from planes, common to all points on a patch"},
      {"kernel", &config.kernel, 1.0, 100.0, "", "Tukey cutoff in standard deviations"},
      {"max_gate_m", &config.max_gate_m, 0.0, 100.0, "m", "largest Tukey cutoff while the start is uncertain"},
      {"rotation_step_rad", &config.rotation_step_rad, 1e-12, 1.0, "rad", "converged when a step rotates by less"},
      {"translation_step_m", &config.translation_step_m, 1e-12, 1.0, "m", "and translates by less"},
  };
}

}  // namespace dynamic_icp::mapping
