// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/fmcw_lidar.hpp"

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::simulation {

ConfigFields fields(FmcwLidarConfig& config) {
  ConfigFields list = {
      {"unit", &config.unit, 0, 1e9, "",
       "which unit of this sensor it is: decides, with the sensor's name, on the errors that are constant for a unit"},
      {"horizontal_fov_deg", &config.horizontal_fov_deg, 1.0, 360.0, "deg", "field of view from left to right"},
      {"vertical_fov_deg", &config.vertical_fov_deg, 0.1, 170.0, "deg", "field of view from top to bottom"},
      {"vertical_center_deg", &config.vertical_center_deg, -80.0, 80.0, "deg",
       "elevation of the middle of the field of view"},
      {"columns", &config.columns, 1, 20000, "", "rays from left to right"},
      {"rows", &config.rows, 1, 1024, "", "rays from top to bottom"},
      {"rate_hz", &config.rate_hz, 0.1, 1000.0, "Hz", "scans a second"},
      {"sweep_s", &config.sweep_s, 0.0, 10.0, "s", "time a scan takes; 0: all rays at the stamp"},
      {"row_by_row", &config.row_by_row, 0, 1, "", "sweeps line by line from top to bottom, not column by column"},
      {"beams", &config.beams, 1, 15, "",
       "beams that measure at once; line by line each sweeps a band of the lines, else they take the lines in turn"},
      {"faces", &config.faces, 1, 15, "", "faces of the mirror; each sweeps a part of the azimuth"},
      {"face_per_scan", &config.face_per_scan, 0, 1, "", "each face sweeps a whole scan, one after the other"},
      {"scatter_deg", &config.scatter_deg, 0.0, 10.0, "deg",
       "in each scan, each ray is turned aside by up to this, across and up; the point is where the ray went"},
      {"min_range_m", &config.min_range_m, 0.01, 100.0, "m", "nearer surfaces give no return and hide what is behind"},
      {"max_range_m", &config.max_range_m, 1.0, 2000.0, "m", "farther surfaces give no return"},
      {"detection_range_m", &config.detection_range_m, 0.0, 5000.0, "m",
       "a surface of 10 % reflectivity, met head-on here, is seen every second time; 0: range does not matter"},
      {"weak_when_dark", &config.weak_when_dark, 0, 1, "",
       "reflectivity counts towards detection; if not, all surfaces have 10 %"},
      {"weak_when_slanted", &config.weak_when_slanted, 0, 1, "",
       "the angle of incidence counts towards detection; if not, all surfaces are met head-on"},
      {"dropout_rate", &config.dropout_rate, 0.0, 1.0, "", "share of returns that are lost whatever they met"},
      {"duplicate_rate", &config.duplicate_rate, 0.0, 1.0, "", "share of returns that are reported twice"},
      {"blind_from_deg", &config.blind_from_deg, -180.0, 180.0, "deg",
       "azimuth at the right end of a sector without returns"},
      {"blind_to_deg", &config.blind_to_deg, -180.0, 180.0, "deg", "azimuth at its left end; no sector where equal"},
      {"beam_divergence_mrad", &config.beam_divergence_mrad, 0.0, 100.0, "mrad",
       "full width of the beam; at edges the stronger surface returns, or a mixture of both"},
      {"range_resolution_m", &config.range_resolution_m, 0.0, 100.0, "m",
       "two surfaces in one beam that are nearer to each other than this give one mixed return between them"},
      {"rain_rate", &config.rain_rate, 0.0, 1.0, "", "share of rays that meet a drop at long range"},
      {"rain_range_m", &config.rain_range_m, 0.1, 100.0, "m", "mean distance of the drops that are seen"},
      {"spray_rate", &config.spray_rate, 0.0, 1.0, "",
       "share of the rays through the spray behind moving bodies that meet a drop"},
      {"window_rate", &config.window_rate, 0.0, 1.0, "", "share of rays that the window before the sensor sends back"},
      {"multipath_rate", &config.multipath_rate, 0.0, 1.0, "",
       "share of returns that are a mirror image behind the surface that is met"},
      {"roughness_m", &config.roughness_m, 0.0, 1.0, "m",
       "standard deviation of surfaces along their normals, fixed to them"},
      {"foliage_sway_m", &config.foliage_sway_m, 0.0, 1.0, "m", "how far wind moves leaves, as of one sine"},
      {"range_noise_m", &config.range_noise_m, 0.0, 10.0, "m", "standard deviation of the range"},
      {"range_step_m", &config.range_step_m, 0.0, 1.0, "m", "ranges are multiples of this; 0: any"},
      {"angle_noise_deg", &config.angle_noise_deg, 0.0, 10.0, "deg",
       "standard deviation of the measured direction, across and up"},
      {"doppler_noise_mps", &config.doppler_noise_mps, 0.0, 10.0, "m/s", "standard deviation of the Doppler"},
      {"doppler_bias_mps", &config.doppler_bias_mps, -10.0, 10.0, "m/s", "added to every Doppler value"},
      {"doppler_step_mps", &config.doppler_step_mps, 0.0, 1.0, "m/s", "Doppler values are multiples of this; 0: any"},
      {"doppler_outlier_rate", &config.doppler_outlier_rate, 0.0, 1.0, "", "share of returns with a senseless Doppler"},
      {"doppler_outlier_span_mps", &config.doppler_outlier_span_mps, 0.0, 200.0, "m/s",
       "a senseless Doppler is uniform between minus and plus this"},
  };
  append_fields(list, "timing", fields(config.timing));
  append_fields(list, "doppler_error", fields(config.doppler_error));
  append_fields(list, "pointing_error", fields(config.pointing_error));
  return list;
}

void check(FmcwLidarConfig config) {
  check_fields(fields(config));
  if (config.min_range_m >= config.max_range_m) {
    throw UsageError("configuration key 'min_range_m' must be below 'max_range_m'");
  }
  if (config.sweep_s * config.rate_hz > 1.0 + 1e-9) {
    throw UsageError(fmt::format("configuration key 'sweep_s': {:g} s is longer than the {:g} s from scan to scan",
                                 config.sweep_s, 1.0 / config.rate_hz));
  }
  if (config.timing.start_s * config.rate_hz >= 1.0) {
    throw UsageError(fmt::format("configuration key 'timing.start_s': {:g} s is not below the {:g} s from scan to scan",
                                 config.timing.start_s, 1.0 / config.rate_hz));
  }
  if (config.row_by_row && config.rows % config.beams != 0) {
    throw UsageError(fmt::format("configuration key 'beams': {} bands of equal height cannot be made of {} rows",
                                 config.beams, config.rows));
  }
  if (config.doppler_error.weak_noise_mps > 0.0 && config.detection_range_m <= 0.0) {
    throw UsageError("configuration key 'doppler_error.weak_noise_mps' needs a 'detection_range_m' above 0");
  }
}

FmcwLidarConfig without_noise(FmcwLidarConfig config) {
  const FmcwLidarConfig perfect;
  config.detection_range_m = perfect.detection_range_m;
  config.dropout_rate = perfect.dropout_rate;
  config.beam_divergence_mrad = perfect.beam_divergence_mrad;
  config.rain_rate = perfect.rain_rate;
  config.spray_rate = perfect.spray_rate;
  config.window_rate = perfect.window_rate;
  config.multipath_rate = perfect.multipath_rate;
  config.roughness_m = perfect.roughness_m;
  config.foliage_sway_m = perfect.foliage_sway_m;
  config.range_noise_m = perfect.range_noise_m;
  config.range_step_m = perfect.range_step_m;
  config.angle_noise_deg = perfect.angle_noise_deg;
  config.doppler_noise_mps = perfect.doppler_noise_mps;
  config.doppler_bias_mps = perfect.doppler_bias_mps;
  config.doppler_step_mps = perfect.doppler_step_mps;
  config.doppler_outlier_rate = perfect.doppler_outlier_rate;
  config.duplicate_rate = perfect.duplicate_rate;
  config.blind_from_deg = perfect.blind_from_deg;
  config.blind_to_deg = perfect.blind_to_deg;
  config.timing = without_errors(config.timing);
  config.doppler_error = perfect.doppler_error;
  config.pointing_error = perfect.pointing_error;
  return config;
}

FmcwLidarConfig instant(FmcwLidarConfig config) {
  config.sweep_s = 0.0;
  return config;
}

}  // namespace dynamic_icp::simulation
