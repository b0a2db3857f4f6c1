// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/tools/simulation/direction_field.hpp"

namespace dynamic_icp::simulation {

/// Errors of the Doppler besides white noise of each point. "Standard deviation between" means that each of them has a
/// constant error of its own, drawn for the unit of the sensor; docs/simulator.md says which figures have sources.
struct DopplerErrorConfig {
  // Constant in time: what a calibration of the unit can find.
  double sensor_mps = 0.0;
  double line_mps = 0.0;
  double beam_mps = 0.0;
  double face_mps = 0.0;
  double direction_mps = 0.0;
  double range_mps_per_100m = 0.0;
  double near_mps = 0.0;
  double incidence_mps = 0.0;
  double intensity_mps_per_10db = 0.0;
  double scale = 0.0;

  // Slow: a calibration goes out of date.
  double drift_mps_per_sqrt_s = 0.0;
  double restart_s = 0.0;
  double restart_mps = 0.0;

  // Noise.
  double scan_noise_mps = 0.0;
  double firing_noise_mps = 0.0;
  double noise_mps_per_100m = 0.0;
  double weak_noise_mps = 0.0;
  double ambiguity_mps = 0.0;
};

ConfigFields fields(DopplerErrorConfig& config);

/// Whether any of the errors that are no noise is on.
bool has_systematic_error(const DopplerErrorConfig& config);

/// What the error of one return depends on.
struct DopplerCause {
  std::size_t line = 0;
  std::size_t beam = 0;
  std::size_t face = 0;
  double azimuth_rad = 0.0;
  double elevation_rad = 0.0;
  double range_m = 0.0;
  double cos_incidence = 1.0;
  double intensity_db = 0.0;  ///< over a 10 % surface head-on at 1 m
  double doppler_mps = 0.0;   ///< without any error
  double time_s = 0.0;        ///< since the first scan
};

/// The errors of one unit of a sensor that are no noise.
class DopplerError {
 public:
  DopplerError(const DopplerErrorConfig& config, const AngularSpan& view, const RandomSource& unit);

  /// The error (m/s) without drift:
  ///   sensor + line + beam + face + direction(azimuth, elevation) + range_mps_per_100m * r / 100
  ///   + near * exp(-r / 10 m) + incidence * (1 - cos) + intensity_mps_per_10db * (intensity + 30 dB) / 10
  ///   + scale * doppler, and `restart_mps` from `restart_s` on. Intensities below -60 dB count as that.
  [[nodiscard]] double systematic_mps(const DopplerCause& cause) const;

  /// The drift (m/s) at the begin of a scan: the sum of one step per scan before, of the standard deviation
  /// drift * sqrt(period). `drive` is forked by the number of the scan.
  [[nodiscard]] double drift_mps(std::size_t scan, double period_s, const RandomSource& drive) const;

 private:
  DopplerErrorConfig config_;
  bool is_on_;
  RandomSource lines_;
  RandomSource beams_;
  RandomSource faces_;
  double sensor_ = 0.0;
  DirectionField direction_;
};

/// Standard deviation (m/s) of the noise of one point: the root of the sum of the squares of `white_mps`,
/// noise_mps_per_100m * r / 100 and weak_noise / sqrt(power), where the power is relative to a return that is found
/// every second time.
double doppler_noise_mps(const DopplerErrorConfig& config, double white_mps, double range_m, double power);

/// The value that a sensor shows which cannot tell velocities 2 * ambiguity apart: in [-ambiguity, ambiguity). The
/// value itself where the ambiguity is 0.
double wrapped(double doppler_mps, double ambiguity_mps);

}  // namespace dynamic_icp::simulation
