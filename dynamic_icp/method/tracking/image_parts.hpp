// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dynamic_icp/method/tracking/image_cells.hpp"
#include "dynamic_icp/method/tracking/patches.hpp"

namespace dynamic_icp::tracking {

/// A part of an image of directions: columns and rows with the outermost ones.
struct ImagePart {
  int first_column = 0;
  int last_column = 0;
  int lowest_row = 0;
  int highest_row = 0;

  /// Of no cells.
  static ImagePart none() { return {kImageColumns, -1, kImageRows, -1}; }

  /// Makes room for a cell. What lies on both sides of where the image begins makes the part go all around.
  void include(int column, int row) {
    first_column = std::min(first_column, column);
    last_column = std::max(last_column, column);
    lowest_row = std::min(lowest_row, row);
    highest_row = std::max(highest_row, row);
  }
};

/// In which part of the image the points of each patch of a scan may be, by the bounds of the patches alone; and which
/// patches somebody has not yet looked at.
class ImageParts {
 public:
  /// Of all patches, none of which was looked at, in the memory of another scan.
  void reset(const ScanPatches& patches);

  /// The patches that may have points in a part and were not looked at, ascending: until the next call of either.
  const std::vector<std::uint32_t>& unseen_in(const ImagePart& part) { return find_in(part, 0); }
  /// The same of those that were looked at.
  const std::vector<std::uint32_t>& seen_in(const ImagePart& part) { return find_in(part, 1); }

  [[nodiscard]] bool is_seen(std::size_t patch) const { return is_seen_[patch] != 0; }
  void set_seen(std::size_t patch) { is_seen_[patch] = 1; }

  /// Of patches, with some more at the end that have no rows and count as looked at.
  [[nodiscard]] std::size_t size() const { return is_seen_.size(); }

 private:
  const std::vector<std::uint32_t>& find_in(const ImagePart& part, std::uint8_t is_seen);

  // Of each patch; the last column is beyond the image where the part goes on at its other side.
  std::vector<std::int16_t> first_column_, last_column_;
  std::vector<std::int16_t> lowest_row_, highest_row_;
  std::vector<std::uint8_t> is_seen_;
  std::vector<std::uint8_t> is_found_;
  std::vector<std::uint32_t> found_;
};

}  // namespace dynamic_icp::tracking
