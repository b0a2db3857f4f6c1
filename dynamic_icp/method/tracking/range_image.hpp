// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/tracking/flags.hpp"
#include "dynamic_icp/method/tracking/patches.hpp"

namespace dynamic_icp::tracking {

/// How far one sees in each direction: the range of the nearest point in cells of about half a degree by one degree.
/// Tells the true end of a body from the place where something nearer begins to hide it.
///
/// Made for bodies on the ground around the sensor: what is seen more than 46 degrees above or below its horizontal
/// plane shares the outermost cells, and the edge of the field of view is known sideways and as the lowest and the
/// highest that was seen anywhere.
class RangeImage {
 public:
  /// Where nothing is seen.
  RangeImage() = default;

  /// From a deskewed scan, as it was measured: `velocity_sensor` (m/s) is that of the sensor.
  RangeImage(const Scan& scan, const Eigen::Vector3d& velocity_sensor, const Workers& workers) {
    draw(scan, velocity_sensor, workers);
  }

  /// The same in the memory of another scan.
  void draw(const Scan& scan, const Eigen::Vector3d& velocity_sensor, const Workers& workers);

  /// Whether what is at `point` (m, sensor frame when that direction was measured) is hidden, or would be: something at
  /// least `clearance_m` nearer is seen in its direction, or nothing is seen above and below it either, or nowhere so
  /// low, as beyond the edge of the field of view. A negative clearance: also by what is so much farther away.
  [[nodiscard]] bool hides(const Eigen::Vector3d& point, double clearance_m) const;

  /// Whether nothing in the whole scan is seen as high as `point` (m, sensor frame): it may be above the field of view.
  [[nodiscard]] bool is_above_all(const Eigen::Vector3d& point) const;

  /// Whether these rows of the scan (at least one) seem to be seen through something nearer: most of them lie behind
  /// what is seen in their directions and all around, and are few beside it. So do mirror images. What is seen through
  /// a fence or leaves is more.
  [[nodiscard]] bool are_mirrored(std::span<const std::uint32_t> rows) const;

  /// Calls visit(begin, end) for the rows [begin, end) of each patch of the deskewed scan that may have points in a
  /// place, ascending.
  template <typename Visit>
  void visit_patches(const SoughtPlace& place, const Visit& visit) const {
    std::size_t block_begin = 0;
    for (const PatchBlock& patches : patches_) {
      PatchBlock::Flags may_hold;
      patches.find(place, may_hold);
      visit_flagged(may_hold, 0, patches.count(), [&](std::size_t patch) {
        const std::size_t begin = block_begin + patch * PatchBlock::kRows;
        visit(begin, std::min(begin + PatchBlock::kRows, places_.size()));
      });
      block_begin += PatchBlock::kRows * PatchBlock::kPatches;
    }
  }

  /// A part of the image, with its outermost rows and columns.
  struct Part {
    int lowest = 0;
    int highest = 0;
    int first_column = 0;
    int last_column = 0;
  };

  /// Width of a cell at a distance of one metre, m: what is closer together may share one.
  static double cell_width();

 private:
  std::vector<float> nearest_squared_;  ///< m^2, column by column; infinite where nothing is seen
  std::vector<char> column_seen_;
  int lowest_seen_ = 0;  ///< row
  int highest_seen_ = 0;
  std::vector<PatchBlock> patches_;

  void find_seen_columns();
  [[nodiscard]] bool is_in_view(int column) const;
  [[nodiscard]] bool is_behind(std::uint32_t row) const;

  // Of each row of the scan, as it was measured
  std::vector<std::uint32_t> places_;  ///< in the image
  std::vector<float> squared_;         ///< of the range, m^2
  std::vector<Part> part_of_block_;
};

}  // namespace dynamic_icp::tracking
