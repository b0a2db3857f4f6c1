// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/window_config.hpp"

namespace dynamic_icp::window {

ConfigFields fields(WindowConfig& config) {
  return {
      {"use_doppler", &config.use_doppler, 0, 0, "", "the Doppler takes part"},
      {"use_planes", &config.use_planes, 0, 0, "", "the planes of the map take part"},
      {"learn_field", &config.learn_field, 0, 0, "", "learn the error field of the Doppler"},
      {"learn_pointing", &config.learn_pointing, 0, 0, "",
       "learn how far the lines of sight of whole scans may be off"},
      {"learn_vibration", &config.learn_vibration, 0, 0, "", "learn how the sensor vibrates"},
      {"knot_spacing_s", &config.knot_spacing_s, 1e-3, 1.0, "s", "between the knots of the trajectory"},
      {"start_jerk_mps3", &config.start_jerk_mps3, 1e-3, 1e6, "m/s^3",
       "standard deviation of the jerk between two knots before it is learned"},
      {"start_jerk_rad_s3", &config.start_jerk_rad_s3, 1e-3, 1e6, "rad/s^3", "the same of the rotation"},
      {"start_vibration_m", &config.start_vibration_m, 1e-7, 0.1, "m",
       "standard deviation of the vibration of the sensor before it is learned"},
      {"start_omega_rad_s", &config.start_omega_rad_s, 1e-3, 1e3, "rad/s",
       "standard deviation of the angular velocity of the first scan"},
      {"start_stamp_sigma_s", &config.start_stamp_sigma_s, 1e-7, 1.0, "s",
       "standard deviation of the stamps of scans before it is learned"},
      {"min_sigma_m", &config.min_sigma_m, 0.0, 10.0, "m", "smallest standard deviation of a point from its plane"},
      {"model_sigma_m", &config.model_sigma_m, 0.0, 10.0, "m",
       "standard deviation of a patch from a plane before it is learned"},
      {"repeated_patches", &config.repeated_patches, 1.0, 100.0, "",
       "the error of a patch comes again in so many scans"},
      {"max_noise_share", &config.max_noise_share, 1e-3, 1.0, "",
       "a motion with this share of its information by the noise of normals is not held by planes"},
      {"max_iterations", &config.max_iterations, 1, 100, "", "Gauss-Newton steps of a scan"},
  };
}

}  // namespace dynamic_icp::window
