// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/config_field.hpp"

namespace dynamic_icp::window {

struct WindowConfig {
  bool use_doppler = true;      ///< off: planes and motion alone (ablation "no-dr")
  bool use_planes = true;       ///< off: Doppler and motion alone
  bool learn_vibration = true;  ///< off: the motion is smooth (ablation "no-vibration")
  bool learn_pointing = true;   ///< off: scans point where they should (ablation "no-pointing")
  bool learn_field = true;      ///< off: the Doppler has no error but noise (ablation "no-bias")
  double knot_spacing_s = 0.0125;
  double start_jerk_mps3 = 30.0;  ///< standard deviation per knot interval before anything is learned
  double start_jerk_rad_s3 = 6.0;
  double start_vibration_m = 2e-4;    ///< standard deviation of the vibration before it is learned
  double start_omega_rad_s = 0.3;     ///< standard deviation of the rotation of the first scan
  double start_stamp_sigma_s = 1e-4;  ///< standard deviation of stamps before it is learned
  double min_sigma_m = 0.005;         ///< smallest standard deviation of a point from its plane
  double model_sigma_m = 0.003;       ///< of a patch from a plane before it is learned
  double repeated_patches = 2.5;      ///< the error of a patch comes again in so many scans
  double max_noise_share = 0.2;       ///< of information that may be noise of normals
  int max_iterations = 7;
};

ConfigFields fields(WindowConfig& config);

/// For what the unknowns of an error field are made (DopplerErrorField).
struct FieldShape {
  /// The directions that a sensor measures in, rad.
  struct View {
    double azimuth_first = 0.0;
    double azimuth_span = 1.0;
    double elevation_first = 0.0;
    double elevation_span = 1.0;
  };
  std::vector<View> views;                  ///< of each sensor
  std::vector<double> line_elevations_rad;  ///< of each line, about; empty without lines
  std::size_t faces = 1;
  double intensity_mean = 0.0;
  double intensity_scale = 0.0;  ///< 1 / standard deviation; 0: all alike

  [[nodiscard]] std::size_t lines() const { return line_elevations_rad.size(); }
};

/// Standard deviation of the time between two scans of which nothing is known: it tells nothing of their stamps.
constexpr double kUnknownPeriod_s = 5e-3;

/// What the estimator learned of a sensor in one recording and may begin with in another one.
struct SensorCalibration {
  FieldShape shape;
  struct Part {
    std::string name;
    double scale_mps = 0.0;         ///< standard deviation of its errors
    std::vector<double> error_mps;  ///< estimates
    std::vector<double> sigma_mps;  ///< their standard deviations
  };
  std::vector<Part> parts;  ///< the groups of the error field
  std::vector<std::vector<double>>
      information;               ///< (s/m)^2, of all errors, without their scales: lower triangle, by rows
  std::vector<double> gradient;  ///< s/m, at the estimates, without their scales
  double stamp_sigma_s = 0.0;
  double period_sigma_s = kUnknownPeriod_s;  ///< standard deviation of the time between two scans from whole periods
  double scan_error_mps = 0.0;               ///< standard deviation of what all Doppler values of a scan have in common
};

}  // namespace dynamic_icp::window
