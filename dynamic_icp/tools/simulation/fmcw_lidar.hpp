// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/tools/simulation/doppler_error.hpp"
#include "dynamic_icp/tools/simulation/pointing_error.hpp"
#include "dynamic_icp/tools/simulation/timing.hpp"

namespace dynamic_icp::simulation {

/// A scanning FMCW LiDAR or imaging radar: where it looks, what comes back and how well it measures. The defaults are
/// a perfect, instant sensor; every effect has a number or a switch of its own, and 0 or false is off. Real sensors
/// are the files in simulation/sensors/.
struct FmcwLidarConfig {
  int unit = 0;

  // Where it looks, and when.
  double horizontal_fov_deg = 120.0;
  double vertical_fov_deg = 19.2;
  double vertical_center_deg = 0.0;
  int columns = 1200;
  int rows = 64;
  double rate_hz = 10.0;
  double sweep_s = 0.0;
  bool row_by_row = false;
  int beams = 1;
  int faces = 1;
  bool face_per_scan = false;
  double scatter_deg = 0.0;
  TimingConfig timing;

  // What comes back.
  double min_range_m = 1.0;
  double max_range_m = 250.0;
  double detection_range_m = 0.0;
  bool weak_when_dark = true;
  bool weak_when_slanted = true;
  double dropout_rate = 0.0;
  double duplicate_rate = 0.0;
  double blind_from_deg = 0.0;
  double blind_to_deg = 0.0;
  double beam_divergence_mrad = 0.0;
  double range_resolution_m = 1.0;
  double rain_rate = 0.0;
  double rain_range_m = 5.0;
  double spray_rate = 0.0;
  double window_rate = 0.0;
  double multipath_rate = 0.0;
  double roughness_m = 0.0;
  double foliage_sway_m = 0.0;

  // How well it measures.
  double range_noise_m = 0.0;
  double range_step_m = 0.0;
  double angle_noise_deg = 0.0;
  double doppler_noise_mps = 0.0;
  double doppler_bias_mps = 0.0;
  double doppler_step_mps = 0.0;
  double doppler_outlier_rate = 0.0;
  double doppler_outlier_span_mps = 30.0;
  DopplerErrorConfig doppler_error;
  PointingErrorConfig pointing_error;
};

ConfigFields fields(FmcwLidarConfig& config);

/// Throws UsageError when a value is out of range or values contradict each other.
void check(FmcwLidarConfig config);

/// The same sensor without any error of measurement and without lost, mixed or false returns. It still sweeps.
FmcwLidarConfig without_noise(FmcwLidarConfig config);

/// The same sensor with all rays of a scan at the time of its stamp.
FmcwLidarConfig instant(FmcwLidarConfig config);

}  // namespace dynamic_icp::simulation
