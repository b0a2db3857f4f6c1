// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/sensor_unit.hpp"

#include "dynamic_icp/tools/simulation/named_source.hpp"
#include "dynamic_icp/tools/simulation/units.hpp"

namespace dynamic_icp::simulation {
namespace {

RandomSource source_of(const FmcwLidarConfig& lidar, std::string_view name) {
  return named_source(RandomSource(static_cast<std::uint64_t>(lidar.unit)), name);
}

AngularSpan view_of(const FmcwLidarConfig& lidar) {
  return {kRadians * lidar.horizontal_fov_deg, kRadians * lidar.vertical_fov_deg, kRadians * lidar.vertical_center_deg};
}

}  // namespace

SensorUnit::SensorUnit(const FmcwLidarConfig& lidar, std::string_view name)
    : config(lidar),
      doppler(lidar.doppler_error, view_of(lidar), source_of(lidar, name)),
      pointing(lidar.pointing_error, source_of(lidar, name)) {}

}  // namespace dynamic_icp::simulation
