// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/tools/simulation/fmcw_lidar.hpp"

namespace dynamic_icp::simulation {

/// One ray of a firing.
struct PatternRay {
  double azimuth_rad = 0.0;    ///< from x (forward) to y (left)
  double elevation_rad = 0.0;  ///< up
  std::uint16_t line = 0;      ///< row, 0 at the top
  std::uint8_t beam = 0;       ///< which of the beams that measure at once
  std::uint8_t face = 0;       ///< of the mirror, 0 where each face sweeps a whole scan
};

/// Rays that leave the sensor at the same time.
struct Firing {
  double time_s = 0.0;  ///< after the scan's stamp
  std::vector<PatternRay> rays;
};

/// The order in which a scan is made. A pattern is plain data: the simulation honours any times in it.
using ScanPattern = std::vector<Firing>;

/// The pattern of a sensor: a grid of equal angles. By columns: from left to right, all rays of a column at once; the
/// beams take the lines in turn. Row by row: from top to bottom, each row from left to right, as many rays at once as
/// there are rows. With several beams row by row, interleaved: each beam sweeps a band of the rows of its own, all of
/// them at once. Firings follow each other at equal times over the sweep. Faces have equal parts of the azimuth, from
/// left to right.
ScanPattern scan_pattern(const FmcwLidarConfig& config);

/// The unit vector (cos e cos a, cos e sin a, sin e) in the sensor frame.
Eigen::Vector3d direction(double azimuth_rad, double elevation_rad);

}  // namespace dynamic_icp::simulation
