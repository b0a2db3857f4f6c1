// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/motion/rotation_filter_config.hpp"

namespace dynamic_icp::motion {

ConfigFields fields(RotationFilterConfig& config) {
  return {
      {"start_omega_rad_s", &config.start_omega_rad_s, 1e-3, 100.0, "rad/s",
       "standard deviation of the angular velocity at the first scan"},
      {"alpha_rad_s2", &config.alpha_rad_s2, 1e-3, 1000.0, "rad/s^2", "standard deviation of the angular acceleration"},
      {"alpha_time_s", &config.alpha_time_s, 1e-2, 100.0, "s", "how long an angular acceleration lasts"},
  };
}

}  // namespace dynamic_icp::motion
