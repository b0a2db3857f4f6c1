// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "dynamic_icp/tools/simulation/doppler_error.hpp"
#include "dynamic_icp/tools/simulation/fmcw_lidar.hpp"
#include "dynamic_icp/tools/simulation/pointing_error.hpp"

namespace dynamic_icp::simulation {

/// One unit of a sensor: its settings and the errors that came with it. They depend on the sensor's name and
/// `config.unit` alone: a calibration learned on one drive holds on every other.
struct SensorUnit {
  explicit SensorUnit(const FmcwLidarConfig& lidar, std::string_view name = "");

  FmcwLidarConfig config;
  DopplerError doppler;
  PointingError pointing;
};

}  // namespace dynamic_icp::simulation
