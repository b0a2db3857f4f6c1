// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dynamic_icp/method/tracking/moving_cells.hpp"

namespace dynamic_icp::tracking {

/// Cells that may be one object.
struct CellGroup {
  std::vector<std::uint32_t> cells;  ///< numbers of cells, ascending
  std::vector<std::uint32_t> rows;   ///< their rows of the scan, ascending
};

/// The groups that some of the cells (ascending) make among themselves, if they have `min_points` points, in the order
/// of their first cells. What is wider than `largest_width_m` seen from above, in every direction, is no single
/// vehicle: it is parted with shorter links, as far as that goes.
std::vector<CellGroup> vehicle_groups(const MovingCells& moving, std::span<const std::uint32_t> cells,
                                      double largest_width_m, int min_points, const GroupingConfig& config);

}  // namespace dynamic_icp::tracking
