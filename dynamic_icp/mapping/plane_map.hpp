// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/base/config_field.hpp"
#include "dynamic_icp/base/parallel.hpp"
#include "dynamic_icp/mapping/plane.hpp"

namespace dynamic_icp::mapping {

struct PlaneMapConfig {
  double finest_cell_m = 0.5;  ///< edge of the cells of the finest level; each level above has twice the edge
  int levels = 3;
  double memory_scans = 10.0;  ///< the weight of a point falls to 1/e in about so many scans; 0: only the last scan
  double max_range_m = 200.0;  ///< cells farther from the sensor are dropped
  PlaneRule plane;
};

ConfigFields fields(PlaneMapConfig& config);

/// A plane of the map under its number.
struct Patch {
  Plane plane;
  std::uint32_t id = 0;  ///< below `PlaneMap::patch_limit()`; may change whenever scans are added
};

/// The static surroundings of the sensor in the last scans, as patches of surface.
///
/// Space is divided into cubic cells on several levels. Each cell sums up the moments of the points in it; older scans
/// fade. Where the points of a coarse cell lie in one plane it is used as a whole, because more points on a wider base
/// make a better normal; else its finer cells are asked. Points in no plane (foliage, edges) stay in the moments and
/// are never found.
///
/// Everything depends on the order of the calls alone. Searches may run at the same time; `add` may not run beside
/// anything.
class PlaneMap {
 public:
  /// Throws std::invalid_argument when the configuration is impossible.
  explicit PlaneMap(const PlaneMapConfig& config);

  /// Adds a scan: points in map axes (m), taken at `position`. Ages what is there, drops what is old or far from
  /// `position`, and fits the planes of all cells that changed. Points more than 2^20 cells from the origin are left
  /// out.
  void add(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& position, const Workers& workers);

  /// The patch of the coarsest level around a point, or null. Valid until the next `add`.
  [[nodiscard]] const Patch* find(const Eigen::Vector3d& point) const;

  /// One above the largest id of a patch.
  [[nodiscard]] std::uint32_t patch_limit() const { return patch_limit_; }

  [[nodiscard]] bool empty() const { return scans_ == 0; }

  /// Forgets everything.
  void clear();

 private:
  struct Cell {
    std::uint64_t key = 0;
    Moments moments;  ///< relative to the centre of the cell
    std::uint32_t last_scan = 0;
    bool is_plane = false;
    Patch patch;
  };

  /// All cells with one edge: open addressing over a dense list.
  struct Level {
    double edge_m = 0.0;
    std::vector<Cell> cells;
    std::vector<std::uint32_t> slots;
    std::vector<std::uint32_t> touched;  ///< cells that changed since their planes were fitted

    [[nodiscard]] std::size_t slot_of(std::uint64_t key) const;
    std::uint32_t cell_at(std::uint64_t key);
    void rebuild(std::size_t slot_count);
  };

  void add_points(Level& level, std::span<const Eigen::Vector3d> points) const;
  void drop_cells(Level& level, const Eigen::Vector3d& position) const;
  void fit_planes(Level& level, const Workers& workers) const;

  PlaneMapConfig config_;
  std::vector<Level> levels_;  ///< coarsest first
  std::uint32_t scans_ = 0;
  std::uint32_t patch_limit_ = 0;
};

}  // namespace dynamic_icp::mapping
