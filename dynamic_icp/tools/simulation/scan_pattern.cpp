// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/scan_pattern.hpp"

#include <cmath>

#include "dynamic_icp/tools/simulation/units.hpp"

namespace dynamic_icp::simulation {
namespace {

/// The angle of the middle of cell `i` of `n` over a field of view, from +fov/2 down to -fov/2.
double cell_angle(int i, int n, double fov_deg) { return fov_deg * kRadians * (0.5 - (i + 0.5) / n); }

PatternRay grid_ray(const FmcwLidarConfig& config, int column, int row) {
  const int beam = config.row_by_row ? row / (config.rows / config.beams) : row % config.beams;
  const int face = config.face_per_scan ? 0 : column * config.faces / config.columns;
  return {cell_angle(column, config.columns, config.horizontal_fov_deg),
          config.vertical_center_deg * kRadians + cell_angle(row, config.rows, config.vertical_fov_deg),
          static_cast<std::uint16_t>(row), static_cast<std::uint8_t>(beam), static_cast<std::uint8_t>(face)};
}

/// Place of the i-th ray of a scan.
struct Cell {
  int column = 0;
  int row = 0;
};

Cell cell_of_ray(const FmcwLidarConfig& config, int i) {
  if (!config.row_by_row) {
    return {i / config.rows, i % config.rows};
  }
  // Each of the beams makes one ray, then the next column, then the next row of their bands.
  const int beam = i % config.beams;
  const int step = i / config.beams;
  return {step % config.columns, beam * (config.rows / config.beams) + step / config.columns};
}

}  // namespace

ScanPattern scan_pattern(const FmcwLidarConfig& config) {
  ScanPattern pattern;
  Firing firing;
  const int rays = config.columns * config.rows;
  for (int i = 0; i < rays; ++i) {
    const Cell cell = cell_of_ray(config, i);
    firing.rays.push_back(grid_ray(config, cell.column, cell.row));
    if (firing.rays.size() == static_cast<std::size_t>(config.rows)) {
      firing.time_s = config.sweep_s * static_cast<double>(pattern.size()) / config.columns;
      pattern.push_back(std::move(firing));
      firing = {};
    }
  }
  return pattern;
}

Eigen::Vector3d direction(double azimuth_rad, double elevation_rad) {
  return {std::cos(elevation_rad) * std::cos(azimuth_rad), std::cos(elevation_rad) * std::sin(azimuth_rad),
          std::sin(elevation_rad)};
}

}  // namespace dynamic_icp::simulation
