// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "dynamic_icp/method/tracking/ground.hpp"
#include "dynamic_icp/method/tracking/patches.hpp"

namespace dynamic_icp::tracking {

/// How far above or below the plane of the ground it is from place to place: roads bend, and planes are fitted to much
/// of them.
///
/// Only points near the places that somebody asks about are looked at, patch of rows by patch. Questions may come from
/// several threads; the answers are the same in any order.
class GroundHeights {
 public:
  /// A plane.
  explicit GroundHeights(const Ground& ground = {}) : ground_(ground) {}

  /// From the static points near the plane (m, sensor frame; `is_moving` has one flag per point), in the memory of
  /// another scan. `patches`: of them. All three must stay as they are until the last question.
  void begin(const Ground& ground, std::span<const Eigen::Vector3d> points, const ScanPatches& patches,
             std::span<const std::uint8_t> is_moving, const Eigen::Isometry3d& T_world_sensor);

  [[nodiscard]] Eigen::Vector3d up() const { return ground_.up(); }

  /// The ground below something whose lowest point seen is `lowest` (m, world). Where none is seen near by it is that
  /// of the whole scan, unless that lies far below or above the point; `is_hidden_below`: what is below the point could
  /// not be seen.
  [[nodiscard]] Ground below(const Eigen::Vector3d& lowest, bool is_hidden_below = false) const;

 private:
  static constexpr int kCells = 32;  // in each direction
  static constexpr int kBins = 24;   // of heights
  using Histogram = std::array<std::uint16_t, kBins>;

  /// Cells side by side: columns and rows with the outermost ones.
  struct CellRange {
    int first_column = 0;
    int last_column = 0;
    int first_row = 0;
    int last_row = 0;

    template <typename Visit>
    void visit(const Visit& visit) const {
      for (int row = first_row; row <= last_row; ++row) {
        for (int column = first_column; column <= last_column; ++column) {
          visit(static_cast<std::size_t>(row * kCells + column));
        }
      }
    }
  };

  /// Where the points of a patch belong.
  struct Bins {
    std::array<int, PatchBlock::kRows> cell;  ///< -1: nowhere
    std::array<int, PatchBlock::kRows> bin;
  };

  /// The first row from `begin` on that counts.
  [[nodiscard]] std::size_t first_that_counts(std::size_t begin) const {
    return (begin + stride_ - 1) / stride_ * stride_;
  }
  [[nodiscard]] CellRange cells_around(const Eigen::Vector3d& point_world, int reach) const;
  void fill(const CellRange& range) const;
  void add_patch(std::size_t begin, std::size_t end) const;
  void find_bins(std::size_t begin, std::size_t count, Bins& bins) const;

  Ground ground_;
  Eigen::Vector3d sensor_world_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_level_sensor_ = Eigen::Matrix3d::Identity();
  double plane_z_ = 0.0;  ///< of the plane, m, level axes from the sensor
  std::span<const Eigen::Vector3d> points_;
  std::span<const std::uint8_t> is_moving_;
  const ScanPatches* patches_ = nullptr;  ///< none: only the plane is known
  std::size_t stride_ = 1;                ///< rows from one to the next that counts

  // What was looked at: it changes no answer.
  mutable std::mutex mutex_;
  mutable std::vector<std::uint8_t> is_added_;  ///< of each patch
  mutable std::array<std::uint8_t, std::size_t{kCells} * kCells> is_full_{};
  mutable std::array<Histogram, std::size_t{kCells} * kCells> cells_{};
};

}  // namespace dynamic_icp::tracking
