// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/kiss_config.hpp"

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::odometry {

ConfigFields fields(KissConfig& config) {
  return {
      {"deskew", &config.deskew, 0, 0, "",
       "move the points of a sweep to its middle by the last motion, where the scan has times"},
      {"min_range_m", &config.min_range_m, 0.0, 1000.0, "m", "points nearer to the sensor are left out"},
      {"max_range_m", &config.max_range_m, 1.0, 10000.0, "m",
       "points farther from the sensor are left out, in the scan and in the map"},
      // With half of this edge the farthest point is still one of the 2^20 cells that the voxel grid tells apart.
      {"voxel_size_m", &config.voxel_size_m, 0.05, 100.0, "m",
       "edge of the voxels of the map; half of it thins the points of the map, 1.5 times those to be registered"},
      {"max_points_per_voxel", &config.max_points_per_voxel, 1, 1000, "", "most points of a voxel of the map"},
      {"initial_threshold_m", &config.initial_threshold_m, 1e-3, 1e3, "m",
       "expected error of the predicted pose before it is known (sigma)"},
      {"min_motion_m", &config.min_motion_m, 0.0, 1e3, "m",
       "smaller errors of the prediction do not count (delta_min)"},
      {"max_iterations", &config.max_iterations, 1, 10000, "", "most Gauss-Newton steps"},
      {"min_step", &config.min_step, 1e-12, 1.0, "",
       "the registration has converged when the step, rad and m together, is shorter"},
  };
}

void check(const KissConfig& config) {
  if (config.min_range_m >= config.max_range_m) {
    throw UsageError(
        fmt::format("configuration key 'kiss_icp.min_range_m' is {}, expected less than 'kiss_icp.max_range_m' ({} m)",
                    config.min_range_m, config.max_range_m));
  }
}

}  // namespace dynamic_icp::odometry
