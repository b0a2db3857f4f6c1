// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/spatial/cell_order.hpp"
#include "dynamic_icp/method/spatial/disjoint_sets.hpp"
#include "dynamic_icp/method/tracking/grouping_config.hpp"

namespace dynamic_icp::tracking {

/// The moving points of a scan in one small cube.
struct MovingCell {
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();   ///< m, sensor frame: mean of its points
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< mean line of sight, about unit
  double radial_mps = 0.0;                              ///< interpolated median of the radial velocities over ground
  double time_s = 0.0;                                  ///< mean time after the stamp; 0 without times
  std::uint32_t count = 0;                              ///< number of its points
};

/// Cells in the order of their first points.
struct MovingCells {
  std::vector<MovingCell> cells;
  std::vector<std::uint32_t> rows;  ///< of the scan: the moving ones, ascending
  spatial::CellOrder order;         ///< of these rows

  // Memory of gather_cells
  std::vector<std::uint32_t> end_of_block;
  std::vector<double> radial;  ///< m/s, cell by cell
};

/// Sorts the rows with `is_moving` != 0 into cubes. A cube holds few points of anything else than one surface, so its
/// mean stands for it; a single Doppler that is wrong by many m/s would move a mean, but not the median. `radial` has
/// one value per row. `cells` may hold those of another scan.
void gather_cells(const Scan& scan, std::span<const double> radial, std::span<const std::uint8_t> is_moving,
                  const GroupingConfig& config, const Workers& workers, MovingCells& cells);

/// Memory of the functions below. It may be used again.
struct GroupingMemory;

/// A group number 0, 1, ... for each cell, in the order of the first cells: cells belong together when a chain of
/// neighbours joins them, each link short enough for its range and without a jump of the radial velocity. Where the
/// radial velocity of a crossing or turning body passes zero its points are not among the moving ones: slow cells with
/// velocities of opposite signs may be linked across such a gap.
void group_cells(std::span<const MovingCell> cells, const GroupingConfig& config, GroupingMemory& memory,
                 std::vector<std::uint32_t>& groups);

/// Groups of cells, each of which may be one object.
struct CellGroups {
  std::vector<std::uint32_t> cells;       ///< numbers of cells, group by group, ascending in each
  std::vector<std::uint32_t> first_cell;  ///< group g holds the places [first_cell[g], first_cell[g + 1]) of these
  std::vector<std::uint32_t> rows;        ///< their rows of the scan, in the same way
  std::vector<std::uint32_t> first_row;

  [[nodiscard]] std::size_t size() const { return first_cell.empty() ? 0 : first_cell.size() - 1; }
  [[nodiscard]] std::span<const std::uint32_t> cells_of(std::size_t group) const {
    return std::span(cells).subspan(first_cell[group], first_cell[group + 1] - first_cell[group]);
  }
  [[nodiscard]] std::span<const std::uint32_t> rows_of(std::size_t group) const {
    return std::span(rows).subspan(first_row[group], first_row[group + 1] - first_row[group]);
  }
};

/// The groups that some of the cells (ascending) make among themselves, if they have `min_points` points, in the order
/// of their first cells. What is wider than `largest_width_m` seen from above, in every direction, is no single
/// vehicle: it is parted with shorter links, as far as that goes.
void vehicle_groups(const MovingCells& moving, std::span<const std::uint32_t> cells, double largest_width_m,
                    int min_points, const GroupingConfig& config, GroupingMemory& memory, CellGroups& groups);

/// What links a cell to others.
struct NearCell {
  Eigen::Vector3d centroid;  ///< m, sensor frame
  double range_m = 0.0;
  double radial_mps = 0.0;
  std::uint32_t number = 0;
  bool beside_gap = false;  ///< it may lie where the radial velocity of its body passes zero
};

struct GroupingMemory {
  // Of cells near each other
  std::vector<NearCell> near;
  std::vector<NearCell> sorted;
  spatial::CellOrder cubes;
  std::vector<std::uint64_t> keys;
  std::vector<std::uint8_t> is_one_set;  ///< for each cube
  spatial::DisjointSets sets;
  std::vector<std::uint32_t> number_of_root;

  // Of groups among some of the cells
  std::vector<MovingCell> chosen;
  std::vector<std::uint32_t> numbers;
  std::vector<std::uint32_t> sizes;
  std::vector<std::size_t> points;
  std::vector<std::uint32_t> places;
  CellGroups wide;
  std::vector<std::uint32_t> group_of_cell;
};

}  // namespace dynamic_icp::tracking
