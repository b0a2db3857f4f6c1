// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/tracking/image_cells.hpp"
#include "dynamic_icp/method/tracking/image_parts.hpp"
#include "dynamic_icp/method/tracking/patches.hpp"

namespace dynamic_icp::tracking {

/// The cells of a range image, of which only those are filled that somebody asks about, patch of rows by patch.
///
/// Several threads may ask. What has been filled is read without a lock: a cell is marked once all patches that may
/// have points in it are drawn, and no other patch changes it. The nearest of points does not depend on their order.
class LazyImage {
 public:
  /// Of a deskewed scan, as it was measured by a sensor with this velocity (m/s). The scan and its patches must stay as
  /// they are until the last question. `patches`: of its points, or, of a scan with times, of anything that lies in the
  /// directions in which they were measured.
  void begin(const Scan& scan, const ScanPatches& patches, const Eigen::Vector3d& velocity_sensor);

  /// Draws all of it. The scan is not needed any more.
  void draw_all();

  /// Squared range of the nearest point in a cell, m^2; infinite where there is none.
  [[nodiscard]] float nearest_squared(int column, int row) {
    const std::size_t tile = tile_of(column, row);
    if (is_full_[tile].load(std::memory_order_acquire) == 0) {
      fill(tile);
    }
    return nearest_squared_[place_in_image(column, row)];
  }

  /// Whether a column has a point in any row.
  [[nodiscard]] bool sees(int column);

  /// Whether the scan has no point in this row or a lower one, or in this row or a higher one.
  [[nodiscard]] bool is_below_all(int row);
  [[nodiscard]] bool is_above_all(int row);

  /// Draws some rows of the scan, so that `place` and `squared` of them are known.
  void draw_rows(std::span<const std::uint32_t> rows);
  [[nodiscard]] std::uint32_t place(std::uint32_t row) const { return places_[row]; }  ///< of a cell
  [[nodiscard]] float squared(std::uint32_t row) const { return squared_[row]; }       ///< of the range, m^2

  /// Draws all points that are in a part.
  void draw_part(const ImagePart& part);

  /// Calls visit(row) for all rows of the scan whose points are in a part and drawn, and others near it.
  template <typename Visit>
  void visit_drawn(const ImagePart& part, const Visit& visit) {
    const std::scoped_lock lock(mutex_);
    for (const std::uint32_t patch : parts_.seen_in(part)) {
      const std::size_t begin = patch * PatchBlock::kRows;
      for (std::size_t row = begin; row < std::min(rows_, begin + PatchBlock::kRows); ++row) {
        visit(static_cast<std::uint32_t>(row));
      }
    }
  }

 private:
  static constexpr int kTileColumns = 2;
  static constexpr int kTileRows = 15;
  static constexpr int kTilesAbove = kImageRows / kTileRows;
  static constexpr std::size_t kTiles = std::size_t{kImageColumns / kTileColumns} * kTilesAbove;
  static_assert(kImageColumns % kTileColumns == 0 && kImageRows % kTileRows == 0);

  /// What is known of a column.
  enum class Column : std::uint8_t { kUnknown, kSeen, kEmpty };

  static std::size_t tile_of(int column, int row) {
    return static_cast<std::size_t>(column / kTileColumns * kTilesAbove + row / kTileRows);
  }

  void fill(std::size_t tile);

  // With the lock
  void draw(std::size_t patch);
  [[nodiscard]] bool has_drawn(int column) const;
  template <typename IsEnough>
  void draw_until(const ImagePart& part, const IsEnough& is_enough);

  const Scan* scan_ = nullptr;
  Eigen::Vector3d velocity_sensor_ = Eigen::Vector3d::Zero();
  std::size_t rows_ = 0;  ///< of the scan

  std::mutex mutex_;  ///< of what changes
  ImageParts parts_;
  std::vector<float> nearest_squared_;  ///< column by column
  std::vector<std::uint32_t> places_;   ///< of each row of the scan
  std::vector<float> squared_;
  std::array<std::atomic<std::uint8_t>, kTiles> is_full_{};
  std::array<std::atomic<Column>, kImageColumns> columns_{};
  std::atomic<int> lowest_ = kImageRows;  ///< row of what is drawn
  std::atomic<int> highest_ = 0;
};

}  // namespace dynamic_icp::tracking
