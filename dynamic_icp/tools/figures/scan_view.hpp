// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/recording/runs/run_folder.hpp"
#include "dynamic_icp/tools/drawing/axes.hpp"

namespace dynamic_icp::figures {

/// One scan and what the run found in it.
struct ScanView {
  std::string title;  ///< e.g. "Scan 23"
  Scan scan;
  Eigen::Vector3d ego_velocity = Eigen::Vector3d::Zero();  ///< m/s, sensor frame; NaN when it is not known
  std::vector<runs::ObjectRow> objects;
  std::vector<std::int32_t> labels;  ///< per record of the scan as read (see `runs::read_labels`); empty: not known
};

/// Part of the ground plane of the sensor: m, x forward, y to the left.
struct Region {
  drawing::Range x;
  drawing::Range y;

  [[nodiscard]] Eigen::Vector3d middle() const {
    return {0.5 * (x.minimum + x.maximum), 0.5 * (y.minimum + y.maximum), 0.0};
  }
  [[nodiscard]] bool contains(double px, double py) const {
    return px >= x.minimum && px <= x.maximum && py >= y.minimum && py <= y.maximum;
  }
};

/// One row for each square of `cell_m` metres of the ground plane in which the scan has points: the one whose Doppler
/// is the median of its square, a value that was measured and no outlier. Ordered by squares.
std::vector<std::uint32_t> rows_per_cell(const Scan& scan, double cell_m);

/// The part that shows the scene: most of what the scan saw, the sensor, and the objects, seen from above. A few far
/// returns are left outside. `rows` are those of `rows_per_cell`, so that near and far count alike.
Region region_of_interest(const Scan& scan, std::span<const std::uint32_t> rows,
                          std::span<const runs::ObjectRow> objects);

/// The horizontal field of view: the azimuths (rad, 0 forward, positive to the left) between which nearly all rows
/// lie.
drawing::Range field_of_view(const Scan& scan);

/// The rows of the scan on an object: by the labels or, without them, the points near its centroid that move, and
/// whose Doppler without own motion (`compensated`) agrees with its velocity.
std::vector<std::uint32_t> rows_on_object(const ScanView& view, const std::vector<double>& compensated,
                                          const runs::ObjectRow& object);

/// The box of an object from above: around its rows, or where those are too few, its extent around its centroid.
Region footprint(const ScanView& view, std::span<const std::uint32_t> rows, const runs::ObjectRow& object);

}  // namespace dynamic_icp::figures
