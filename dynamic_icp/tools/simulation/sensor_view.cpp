// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/sensor_view.hpp"

#include <algorithm>
#include <cmath>

#include "dynamic_icp/tools/simulation/units.hpp"

namespace dynamic_icp::simulation {

drawing::Raster sensor_view(const FmcwLidarConfig& lidar, const SimulatedScan& scan, std::size_t width,
                            drawing::Rgb nothing, const std::function<drawing::Rgb(std::size_t)>& colour_of) {
  const std::size_t columns = std::min(width, static_cast<std::size_t>(lidar.columns));
  const auto rows = static_cast<std::size_t>(lidar.rows);
  drawing::Raster raster(columns, rows, nothing);
  const double top = kRadians * (lidar.vertical_center_deg + 0.5 * lidar.vertical_fov_deg);
  const double left = kRadians * 0.5 * lidar.horizontal_fov_deg;
  const auto cell = [](double share, std::size_t count) {
    const double place = std::floor(share * static_cast<double>(count));
    return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(count - 1)));
  };
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    const Eigen::Vector3d u = scan.measured.points[i].normalized();
    const double across = (left - std::atan2(u.y(), u.x())) / (kRadians * lidar.horizontal_fov_deg);
    const double down = (top - std::asin(u.z())) / (kRadians * lidar.vertical_fov_deg);
    raster.set(cell(across, columns), cell(down, rows), colour_of(i));
  }
  return raster;
}

}  // namespace dynamic_icp::simulation
