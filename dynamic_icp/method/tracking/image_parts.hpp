// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dynamic_icp/method/tracking/patches.hpp"

namespace dynamic_icp::tracking {

/// A part of an image of directions: columns and rows with the outermost ones.
struct ImagePart {
  int first_column = 0;
  int last_column = 0;
  int lowest_row = 0;
  int highest_row = 0;
};

/// In which part of the image the points of each patch of a scan may be, by the bounds of the patches alone; and which
/// patches somebody has not yet looked at.
class ImageParts {
 public:
  /// Of all patches, none of which was looked at, in the memory of another scan.
  void reset(const ScanPatches& patches);

  /// The patches that may have points in a part and were not looked at, ascending: until the next call.
  const std::vector<std::uint32_t>& unseen_in(const ImagePart& part);

  [[nodiscard]] bool is_seen(std::size_t patch) const { return is_seen_[patch] != 0; }
  void set_seen(std::size_t patch) { is_seen_[patch] = 1; }

  /// Of patches, with some more at the end that have no rows and count as looked at.
  [[nodiscard]] std::size_t size() const { return is_seen_.size(); }

 private:
  // Of each patch; the last column is beyond the image where the part goes on at its other side.
  std::vector<std::int16_t> first_column_, last_column_;
  std::vector<std::int16_t> lowest_row_, highest_row_;
  std::vector<std::uint8_t> is_seen_;
  std::vector<std::uint8_t> is_found_;
  std::vector<std::uint32_t> found_;
};

}  // namespace dynamic_icp::tracking
