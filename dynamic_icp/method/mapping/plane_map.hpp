// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/mapping/mapping_config.hpp"
#include "dynamic_icp/method/mapping/plane.hpp"
#include "dynamic_icp/method/spatial/cell_key.hpp"
#include "dynamic_icp/method/spatial/key_numbers.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::mapping {

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
/// The coarsest cells are found by hashing; each knows its eight parts, and so on down. The planes of parts are fitted
/// when somebody may ask for them: when their whole is none.
///
/// Everything depends on the order of the calls alone. Searches may run at the same time; `add` may not run beside
/// anything.
class PlaneMap {
 public:
  /// Throws std::invalid_argument when the configuration is impossible.
  explicit PlaneMap(const PlaneMapConfig& config);

  /// Adds a scan: points in map axes (m), taken at `position`. Ages what is there, drops what is old or far from
  /// `position`, and fits the planes of all cells that changed. Points more than 2^20 cells from the origin are left
  /// out. `phases` of the sweep, 0 to 1, one per point or none.
  void add(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& position, const Workers& workers,
           std::span<const double> phases = {});

  /// The patch of the coarsest level around a point, or null. Valid until the next `add`.
  [[nodiscard]] const Patch* find(const Eigen::Vector3d& point) const { return find(finest_cell(point)); }

  /// The finest cell around a point, whether there is anything in it or not. All points in it have the same patch.
  [[nodiscard]] std::uint64_t finest_cell(const Eigen::Vector3d& point) const {
    return spatial::cell_key(per_finest_cell_ * point);
  }
  [[nodiscard]] const Patch* find(std::uint64_t finest_cell) const;

  /// One above the largest id of a patch.
  [[nodiscard]] std::uint32_t patch_limit() const { return static_cast<std::uint32_t>(patches_.size()); }

  /// Cells of all levels that are held in memory.
  [[nodiscard]] std::size_t cell_count() const { return cells_.size() - free_cells_.size(); }

  /// How many were added since the map was empty: the number of the last one.
  [[nodiscard]] std::uint32_t scans() const { return scans_; }

  [[nodiscard]] bool empty() const { return scans_ == 0; }

  /// Standard deviation of the ranges (m): of points on surfaces that face the sensor. Zero until it saw enough.
  [[nodiscard]] double range_sigma_m() const;

  /// Forgets everything but how far ranges err.
  void clear();

  void state(StateArchive& archive);

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// A cell that a point has met. What a search reads stands here, the sums in `moments_` under the same number.
  struct Cell {
    std::array<std::uint32_t, 8> parts;  ///< numbers of the cells it is divided into, or kNone
    std::uint32_t patch = kNone;         ///< its plane, or kNone
    std::uint32_t last_scan = 0;
    bool is_stale = false;  ///< its sums changed since its plane was fitted
  };

  /// A cell whose plane is to be fitted.
  struct Fitting {
    std::uint32_t cell;
    std::uint64_t key;  ///< in units of the edge of its level
  };

  void add_point(const Eigen::Vector3d& point, double phase);
  void touch(std::uint32_t cell);
  void fit_planes(const Workers& workers);
  void fit_level(double edge_m, const Workers& workers);
  void go_down();
  [[nodiscard]] double bend_of(const Fitting& fitting, const Plane& plane, double edge_m) const;
  void learn_range_noise();
  void drop_cells(const Eigen::Vector3d& position);
  void drop_old_parts(std::uint32_t cell);
  void release(std::uint32_t cell);
  void renumber_roots();
  std::uint32_t root_at(std::uint64_t key);
  std::uint32_t new_cell();
  std::uint32_t new_patch();
  void check_read(const StateArchive& archive) const;
  [[nodiscard]] bool is_old(const Cell& cell) const { return cell.last_scan < oldest_; }
  [[nodiscard]] double fade_since(std::uint32_t scan) const;

  PlaneMapConfig config_;
  double per_finest_cell_ = 0.0;  ///< 1/m
  double coarsest_edge_m_ = 0.0;
  double fade_ = 0.0;  ///< of a point from one scan to the next
  std::uint32_t scans_ = 0;
  std::uint32_t oldest_ = 0;          ///< cells that no point met since this scan are forgotten
  spatial::KeyNumbers root_numbers_;  ///< of the coarsest cells that ever were
  std::vector<std::uint64_t> root_keys_;
  std::vector<std::uint32_t> roots_;  ///< the cell of each such number, or kNone when it was dropped
  std::vector<Cell> cells_;
  std::vector<Moments> moments_;  ///< of each cell, relative to its centre
  std::vector<Patch> patches_;
  RangeNoise range_noise_;
  std::vector<double> range_variances_;  ///< m^2, by each patch that faces the sensor, of the scan at hand
  std::vector<std::uint32_t> free_cells_;
  std::vector<std::uint32_t> free_patches_;
  std::vector<Fitting> fitting_;  ///< of one level
  std::vector<Fitting> parts_;    ///< of the level below
};

}  // namespace dynamic_icp::mapping
