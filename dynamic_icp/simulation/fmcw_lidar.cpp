// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/simulation/fmcw_lidar.hpp"

#include <cmath>
#include <numbers>

namespace dynamic_icp::simulation {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

/// The angle of the middle of cell `i` of `n` over a field of view, from +fov/2 down to -fov/2.
double cell_angle(int i, int n, double fov_deg) { return fov_deg * kRadians * (0.5 - (i + 0.5) / n); }

}  // namespace

ConfigFields fields(FmcwLidarConfig& config) {
  return {
      {"horizontal_fov_deg", &config.horizontal_fov_deg, 1.0, 360.0, "deg", "field of view from left to right"},
      {"vertical_fov_deg", &config.vertical_fov_deg, 0.1, 170.0, "deg", "field of view from top to bottom"},
      {"columns", &config.columns, 1, 20000, "", "rays from left to right"},
      {"rows", &config.rows, 1, 1024, "", "rays from top to bottom"},
      {"rate_hz", &config.rate_hz, 0.1, 1000.0, "Hz", "scans a second"},
      {"min_range_m", &config.min_range_m, 0.01, 100.0, "m", "nearer surfaces give no return and hide what is behind"},
      {"max_range_m", &config.max_range_m, 1.0, 2000.0, "m", "farther surfaces give no return"},
      {"range_noise_m", &config.range_noise_m, 0.0, 10.0, "m", "standard deviation of the range"},
      {"doppler_noise_mps", &config.doppler_noise_mps, 0.0, 10.0, "m/s", "standard deviation of the Doppler"},
      {"doppler_bias_mps", &config.doppler_bias_mps, -10.0, 10.0, "m/s", "added to every Doppler value"},
      {"doppler_step_mps", &config.doppler_step_mps, 0.0, 1.0, "m/s", "Doppler values are multiples of this; 0: any"},
      {"doppler_outlier_rate", &config.doppler_outlier_rate, 0.0, 1.0, "", "share of returns with a senseless Doppler"},
      {"doppler_outlier_span_mps", &config.doppler_outlier_span_mps, 0.0, 200.0, "m/s",
       "a senseless Doppler is uniform between minus and plus this"},
      {"dropout_rate", &config.dropout_rate, 0.0, 1.0, "", "share of returns that are lost"},
  };
}

FmcwLidarConfig without_noise(FmcwLidarConfig config) {
  config.range_noise_m = 0.0;
  config.doppler_noise_mps = 0.0;
  config.doppler_bias_mps = 0.0;
  config.doppler_step_mps = 0.0;
  config.doppler_outlier_rate = 0.0;
  config.dropout_rate = 0.0;
  return config;
}

ConfigFields fields(MountConfig& config) {
  return {
      {"x_m", &config.x_m, -20.0, 20.0, "m", "forward of the middle of the vehicle"},
      {"y_m", &config.y_m, -20.0, 20.0, "m", "left of the middle of the vehicle"},
      {"z_m", &config.z_m, 0.1, 20.0, "m", "above the road"},
      {"roll_deg", &config.roll_deg, -180.0, 180.0, "deg", "about the forward axis"},
      {"pitch_deg", &config.pitch_deg, -90.0, 90.0, "deg", "about the left axis: positive looks down"},
      {"yaw_deg", &config.yaw_deg, -180.0, 180.0, "deg", "about the upward axis: positive looks left"},
  };
}

Eigen::Isometry3d T_vehicle_sensor(const MountConfig& mount) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = (Eigen::AngleAxisd(mount.yaw_deg * kRadians, Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(mount.pitch_deg * kRadians, Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(mount.roll_deg * kRadians, Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  T.translation() << mount.x_m, mount.y_m, mount.z_m;
  return T;
}

ScanPattern instant_pattern(const FmcwLidarConfig& config) {
  ScanPattern pattern(static_cast<std::size_t>(config.columns));
  for (int column = 0; column < config.columns; ++column) {
    const double azimuth = cell_angle(column, config.columns, config.horizontal_fov_deg);
    Firing& firing = pattern[static_cast<std::size_t>(column)];
    for (int row = 0; row < config.rows; ++row) {
      const double elevation = cell_angle(row, config.rows, config.vertical_fov_deg);
      firing.directions.emplace_back(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                     std::sin(elevation));
    }
  }
  return pattern;
}

}  // namespace dynamic_icp::simulation
