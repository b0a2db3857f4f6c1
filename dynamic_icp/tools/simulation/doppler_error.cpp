// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/doppler_error.hpp"

#include <algorithm>
#include <cmath>

#include "dynamic_icp/tools/simulation/random_streams.hpp"

namespace dynamic_icp::simulation {
namespace {

constexpr double kNearRange = 10.0;         // m: the data set of Toronto leaves out what is nearer than 5 to 20 m
constexpr double kMiddleIntensity = -30.0;  // dB: a 10 % surface at 32 m
constexpr double kMinIntensity = -60.0;     // dB: drops have none at all

double term(double sigma, const RandomSource& random, std::size_t index) {
  return sigma > 0.0 ? sigma * random.normal(index) : 0.0;
}

}  // namespace

ConfigFields fields(DopplerErrorConfig& config) {
  const auto field = [](const char* key, double* value, double limit, const char* unit, const char* description) {
    return ConfigField{key, value, 0.0, limit, unit, description};
  };
  const auto both_ways = [](const char* key, double* value, double limit, const char* unit, const char* description) {
    return ConfigField{key, value, -limit, limit, unit, description};
  };
  return {
      field("sensor_mps", &config.sensor_mps, 10.0, "m/s", "standard deviation between sensors"),
      field("line_mps", &config.line_mps, 10.0, "m/s", "standard deviation between lines"),
      field("beam_mps", &config.beam_mps, 10.0, "m/s", "standard deviation between beams"),
      field("face_mps", &config.face_mps, 10.0, "m/s", "standard deviation between faces of the mirror"),
      field("direction_mps", &config.direction_mps, 10.0, "m/s",
            "root mean square of an error that changes smoothly with azimuth and elevation"),
      both_ways("range_mps_per_100m", &config.range_mps_per_100m, 10.0, "m/s", "grows by this with 100 m of range"),
      both_ways("near_mps", &config.near_mps, 10.0, "m/s", "at the sensor; falls to 37 % in 10 m of range"),
      both_ways("incidence_mps", &config.incidence_mps, 10.0, "m/s", "times 1 - cos(angle of incidence)"),
      both_ways("intensity_mps_per_10db", &config.intensity_mps_per_10db, 10.0, "m/s",
                "grows by this with ten times the power; 0 for a 10 % surface at 32 m"),
      both_ways("scale", &config.scale, 0.1, "", "part of the Doppler that is measured too much"),
      field("drift_mps_per_sqrt_s", &config.drift_mps_per_sqrt_s, 1.0, "m/s/sqrt(s)",
            "random walk of an error that all points have in common"),
      field("restart_s", &config.restart_s, 1e6, "s", "when the sensor restarts with another constant error"),
      both_ways("restart_mps", &config.restart_mps, 10.0, "m/s", "added to every Doppler value from the restart on"),
      field("scan_noise_mps", &config.scan_noise_mps, 10.0, "m/s", "standard deviation of what a scan has in common"),
      field("firing_noise_mps", &config.firing_noise_mps, 10.0, "m/s",
            "standard deviation of what the rays of one instant have in common"),
      field("noise_mps_per_100m", &config.noise_mps_per_100m, 10.0, "m/s",
            "standard deviation that grows by this with 100 m of range, besides doppler_noise_mps"),
      field("weak_noise_mps", &config.weak_noise_mps, 10.0, "m/s",
            "standard deviation where returns are found every second time; falls with the root of the power"),
      field("ambiguity_mps", &config.ambiguity_mps, 1000.0, "m/s",
            "velocities beyond plus or minus this wrap around; 0: none do"),
  };
}

bool has_systematic_error(const DopplerErrorConfig& config) {
  for (const double value :
       {config.sensor_mps, config.line_mps, config.beam_mps, config.face_mps, config.direction_mps,
        config.range_mps_per_100m, config.near_mps, config.incidence_mps, config.intensity_mps_per_10db, config.scale,
        config.drift_mps_per_sqrt_s, config.restart_mps}) {
    if (value != 0.0) {
      return true;
    }
  }
  return false;
}

DopplerError::DopplerError(const DopplerErrorConfig& config, const AngularSpan& view, const RandomSource& unit)
    : config_(config),
      is_on_(has_systematic_error(config)),
      lines_(unit.fork(kLineDoppler)),
      beams_(unit.fork(kBeamDoppler)),
      faces_(unit.fork(kFaceDoppler)),
      sensor_(term(config.sensor_mps, unit.fork(kSensorDoppler), 0)),
      direction_(config.direction_mps, view, unit.fork(kDirectionDoppler)) {}

double DopplerError::systematic_mps(const DopplerCause& cause) const {
  if (!is_on_) {
    return 0.0;
  }
  double error = sensor_ + term(config_.line_mps, lines_, cause.line) + term(config_.beam_mps, beams_, cause.beam) +
                 term(config_.face_mps, faces_, cause.face) + direction_.at(cause.azimuth_rad, cause.elevation_rad);
  error += config_.range_mps_per_100m * cause.range_m / 100.0;
  error += config_.near_mps != 0.0 ? config_.near_mps * std::exp(-cause.range_m / kNearRange) : 0.0;
  error += config_.incidence_mps * (1.0 - cause.cos_incidence);
  error += config_.intensity_mps_per_10db * (std::max(cause.intensity_db, kMinIntensity) - kMiddleIntensity) / 10.0;
  error += config_.scale * cause.doppler_mps;
  return error + (cause.time_s >= config_.restart_s ? config_.restart_mps : 0.0);
}

double DopplerError::drift_mps(std::size_t scan, double period_s, const RandomSource& drive) const {
  if (config_.drift_mps_per_sqrt_s <= 0.0) {
    return 0.0;
  }
  double steps = 0.0;
  for (std::size_t i = 0; i < scan; ++i) {
    steps += drive.fork(i).normal(kDopplerDrift);
  }
  return config_.drift_mps_per_sqrt_s * std::sqrt(period_s) * steps;
}

double doppler_noise_mps(const DopplerErrorConfig& config, double white_mps, double range_m, double power) {
  if (config.noise_mps_per_100m <= 0.0 && config.weak_noise_mps <= 0.0) {
    return white_mps;
  }
  const double by_range = config.noise_mps_per_100m * range_m / 100.0;
  const double by_power = power > 0.0 ? config.weak_noise_mps * config.weak_noise_mps / power : 0.0;
  return std::sqrt(white_mps * white_mps + by_range * by_range + by_power);
}

double wrapped(double doppler_mps, double ambiguity_mps) {
  if (ambiguity_mps <= 0.0) {
    return doppler_mps;
  }
  return doppler_mps - 2.0 * ambiguity_mps * std::floor((doppler_mps + ambiguity_mps) / (2.0 * ambiguity_mps));
}

}  // namespace dynamic_icp::simulation
