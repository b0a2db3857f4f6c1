// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/sighting.hpp"

#include <algorithm>
#include <cstddef>

namespace dynamic_icp::tracking {
namespace {

constexpr std::size_t kMostPoints = 500;

}  // namespace

Sighting make_sighting(const Scan& scan, std::span<const double> radial, std::span<const std::uint32_t> rows,
                       const SensorMotion& sensor, const RangeImage* view) {
  Sighting sighting;
  const std::size_t stride = std::max<std::size_t>(1, (rows.size() + kMostPoints - 1) / kMostPoints);
  for (std::size_t i = 0; i < rows.size(); i += stride) {
    const std::uint32_t row = rows[i];
    const double time = scan.has_times() ? scan.times()[row] : 0.0;
    sighting.points.push_back(sensor.T_world_sensor * scan.points()[row]);
    sighting.directions.push_back(sensor.direction_world(scan.directions()[row], time));
    sighting.radial.push_back(radial[row]);
    sighting.times.push_back(time);
    sighting.mean_time_s += time;
  }
  sighting.mean_time_s /= static_cast<double>(sighting.points.size());
  sighting.sensor = sensor.position(sighting.mean_time_s);
  sighting.T_sensor_world = sensor.T_world_sensor.inverse();
  sighting.view = view;
  return sighting;
}

Sighting at_mean_time(Sighting sighting, const Eigen::Vector3d& velocity) {
  for (std::size_t i = 0; i < sighting.points.size(); ++i) {
    sighting.points[i] += (sighting.mean_time_s - sighting.times[i]) * velocity;
  }
  return sighting;
}

}  // namespace dynamic_icp::tracking
