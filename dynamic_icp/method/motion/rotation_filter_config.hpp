// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/base/config_field.hpp"

namespace dynamic_icp::motion {

struct RotationFilterConfig {
  double start_omega_rad_s = 0.5;  ///< standard deviation of the angular velocity at the first scan
  double alpha_rad_s2 = 0.5;       ///< standard deviation of the angular acceleration of a vehicle
  double alpha_time_s = 0.5;       ///< how long an angular acceleration lasts
};

ConfigFields fields(RotationFilterConfig& config);

}  // namespace dynamic_icp::motion
