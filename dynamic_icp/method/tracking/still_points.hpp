// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/tracking/expectation.hpp"
#include "dynamic_icp/method/tracking/moving_cells.hpp"
#include "dynamic_icp/method/tracking/range_image.hpp"
#include "dynamic_icp/method/tracking/sensor_motion.hpp"

namespace dynamic_icp::tracking {

/// One scan, prepared for tracking.
struct TrackingInput {
  const Scan& scan;
  std::span<const double> radial;           ///< m/s over ground, for each row
  std::span<const std::uint8_t> is_moving;  ///< for each row
  SensorMotion sensor;
  double stamp_s = 0.0;  ///< since the first scan
  double sweep_s = 0.0;  ///< largest time of a point
  MovingCells moving;
  std::vector<std::uint32_t> groups;             ///< of the cells
  std::vector<Eigen::Vector3d> cell_points;      ///< their centroids, world
  std::vector<Eigen::Vector3d> cell_directions;  ///< their lines of sight, world
  RangeImage view;
};

/// Called with the number of an expectation, a row, and the row's line of sight in world axes.
using StillVisitor = std::function<void(std::size_t expectation, std::uint32_t row, const Eigen::Vector3d& direction)>;

/// Visits each point that is not among the moving ones in the box of each expectation, without the lowest part of the
/// box, where the ground may be. In the order of the rows.
void visit_still_points(const TrackingInput& input, std::span<const Expectation> expectations, const Workers& workers,
                        const StillVisitor& visit);

}  // namespace dynamic_icp::tracking
