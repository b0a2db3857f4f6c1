// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/config_field.hpp"

namespace dynamic_icp::simulation {

/// Where a sensor sits on the vehicle: its pose in the vehicle frame (x forward, y left, z up, origin on the road
/// below the middle of the vehicle).
struct MountConfig {
  double x_m = 1.5;
  double y_m = 0.2;
  double z_m = 1.9;
  double roll_deg = 1.0;
  double pitch_deg = 1.5;
  double yaw_deg = -1.0;
};

ConfigFields fields(MountConfig& config);

/// Rz(yaw) Ry(pitch) Rx(roll) at (x, y, z).
Eigen::Isometry3d T_vehicle_sensor(const MountConfig& mount);

}  // namespace dynamic_icp::simulation
