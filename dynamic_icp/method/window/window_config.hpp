// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/base/config_field.hpp"

namespace dynamic_icp::window {

struct WindowConfig {
  bool use_doppler = true;      ///< off: planes and motion alone (ablation "no-dr")
  bool use_planes = true;       ///< off: Doppler and motion alone
  bool learn_vibration = true;  ///< off: the motion is smooth (ablation "no-vibration")
  bool learn_field = true;      ///< off: the Doppler has no error but noise (ablation "no-bias")
  double knot_spacing_s = 0.0125;
  double start_jerk_mps3 = 30.0;  ///< standard deviation per knot interval before anything is learned
  double start_jerk_rad_s3 = 6.0;
  double start_vibration_m = 2e-4;    ///< standard deviation of the vibration before it is learned
  double start_omega_rad_s = 0.3;     ///< standard deviation of the rotation of the first scan
  double start_stamp_sigma_s = 5e-5;  ///< standard deviation of stamps before it is learned
  double min_sigma_m = 0.005;         ///< smallest standard deviation of a point from its plane
  double model_sigma_m = 0.003;       ///< of a patch from a plane before it is learned
  double repeated_patches = 2.5;      ///< the error of a patch comes again in so many scans
  double max_noise_share = 0.04;      ///< of information that may be noise of normals
  int max_iterations = 7;
};

ConfigFields fields(WindowConfig& config);

}  // namespace dynamic_icp::window
