// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/detection.hpp"

#include <cmath>

namespace dynamic_icp::simulation {
namespace {

constexpr double kReferenceReflectivity = 0.1;
constexpr double kFalseAlarmRate = 1e-6;

}  // namespace

double relative_power(const FmcwLidarConfig& config, const Echo& echo) {
  const double reflectivity = config.weak_when_dark ? echo.reflectivity / kReferenceReflectivity : 1.0;
  const double cosine = config.weak_when_slanted ? echo.cos_incidence : 1.0;
  return reflectivity * cosine * echo.beam_share / (echo.range_m * echo.range_m);
}

double detection_probability(const FmcwLidarConfig& config, const Echo& echo) {
  if (config.detection_range_m <= 0.0) {
    return 1.0;
  }
  const double reference_snr = std::log(kFalseAlarmRate) / std::log(0.5) - 1.0;
  const double reference_power = 1.0 / (config.detection_range_m * config.detection_range_m);
  const double snr = reference_snr * relative_power(config, echo) / reference_power;
  return std::pow(kFalseAlarmRate, 1.0 / (1.0 + snr));
}

}  // namespace dynamic_icp::simulation
