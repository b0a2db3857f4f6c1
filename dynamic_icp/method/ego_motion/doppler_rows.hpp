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

namespace dynamic_icp::ego_motion {

/// The Doppler measurements of a scan, row by row, sorted into cells of space.
///
/// A cell is a cube that holds points. It stands for a piece of surface: its points belong to one thing or to few, so
/// they move together and err together. Votes are counted by cells, because a vehicle near by fills few cells with
/// many points, and the far scene many cells with few.
struct DopplerRows {
  std::vector<double> ux, uy, uz;        ///< line of sight, unit length
  std::vector<double> s;                 ///< m/s, positive away from the sensor
  std::vector<double> dt;                ///< s after `reference_time_s`; zero for scans taken in an instant
  std::vector<std::uint32_t> first;      ///< cell c holds the rows [first[c], first[c + 1])
  std::vector<std::uint32_t> sector;     ///< of each cell: number of the direction sector it is seen in
  std::vector<double> range;             ///< of each cell, m: how far its first point is
  std::vector<std::uint64_t> key;        ///< of each cell: spatial::cell_key
  std::vector<std::uint8_t> on_support;  ///< of each cell: 1 on the surface that carries the scene; empty: not known
  std::size_t sectors = 0;               ///< how many sectors are occupied
  double reference_time_s = 0.0;         ///< s after the stamp: half way between the first and the last point
  double duration_s = 0.0;               ///< between the first and the last point
  bool takes_time = false;               ///< the times of the points differ

  [[nodiscard]] Eigen::Vector3d u(std::size_t row) const { return {ux[row], uy[row], uz[row]}; }
  [[nodiscard]] std::size_t size() const { return s.size(); }
  [[nodiscard]] std::size_t cells() const { return sector.size(); }
};

/// Sorts the points of a scan into cubic cells of `cell_size_m`. Where that leaves few cells, as in a small room, the
/// cells are halved until there are a few hundred or no more to be gained. Cells come in the order of their first
/// point, rows in scan order within their cell.
DopplerRows sort_into_cells(const Scan& scan, double cell_size_m, const Workers& workers);

/// The same into `rows`; its memory and that of `order`, the cells of the points, are used again.
void sort_into_cells(const Scan& scan, double cell_size_m, const Workers& workers, spatial::CellOrder& order,
                     DopplerRows& rows);

/// The rows of the cells of which at most half of the points are flagged (one flag per point of the scan, which `order`
/// sorted and counts), into the memory of `kept`.
void without_rows(const DopplerRows& rows, spatial::CellOrder& order, std::span<const std::uint8_t> flags,
                  DopplerRows& kept);

/// Rows that vote on what is static, and the weight of each vote; the weights sum to one.
struct ConsensusSet {
  DopplerRows rows;  ///< one row per cell
  std::vector<double> weights;
};

/// One row of each of at most `most` cells, evenly over all cells. Half of the support is spread evenly over the cells:
/// the static scene fills more space than dynamic outliers. The other half goes to the farthest cell of each direction
/// sector: whatever moves has something static behind it, so what encloses the scene is static far more often than not,
/// wherever and however the sensor is mounted.
ConsensusSet sample(const DopplerRows& rows, std::size_t most);

}  // namespace dynamic_icp::ego_motion
