// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "dynamic_icp/base/config_field.hpp"

namespace dynamic_icp::simulation {

/// A scanning FMCW LiDAR: what it sees and how well. An effect whose number is 0 is off.
struct FmcwLidarConfig {
  double horizontal_fov_deg = 120.0;
  double vertical_fov_deg = 19.2;
  int columns = 1200;
  int rows = 64;
  double rate_hz = 10.0;
  double min_range_m = 1.0;
  double max_range_m = 250.0;
  double range_noise_m = 0.02;
  double doppler_noise_mps = 0.05;
  double doppler_bias_mps = 0.0;
  double doppler_step_mps = 0.0;
  double doppler_outlier_rate = 0.005;
  double doppler_outlier_span_mps = 30.0;
  double dropout_rate = 0.03;
};

ConfigFields fields(FmcwLidarConfig& config);

/// The same sensor without noise, bias, quantisation, outliers and dropouts.
FmcwLidarConfig without_noise(FmcwLidarConfig config);

/// Where the sensor sits on the vehicle: its pose in the vehicle frame (x forward, y left, z up, origin on the road
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

/// Rays that leave the sensor at the same time.
struct Firing {
  double time_s = 0.0;                      ///< after the scan's stamp
  std::vector<Eigen::Vector3d> directions;  ///< unit length, sensor frame
};

/// The order in which a scan is made. A pattern is plain data: the simulation honours any times in it.
using ScanPattern = std::vector<Firing>;

/// Columns from left to right, each from top to bottom, at equal angles; all at the scan's stamp.
ScanPattern instant_pattern(const FmcwLidarConfig& config);

}  // namespace dynamic_icp::simulation
