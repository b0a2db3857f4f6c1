// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

#include "dynamic_icp/tools/drawing/svg.hpp"

namespace dynamic_icp::drawing {

/// Finds room for labels beside the things they name: greedy, in the order of the calls.
class LabelPlaces {
 public:
  /// Labels stay inside of `area`.
  explicit LabelPlaces(const PixelBox& area) : area_(area) {}

  /// Keeps labels away from a box or from a line.
  void block(const PixelBox& box) { blocked_.push_back(box); }
  void block_line(Pixel from, Pixel to);

  /// Where the text (its left end, on the baseline) beside `thing` stands with the least overlap of everything placed
  /// or blocked before; its place is blocked from then on.
  Pixel place(const PixelBox& thing, std::string_view text, double size);

 private:
  [[nodiscard]] double overlap(const PixelBox& box) const;

  PixelBox area_;
  std::vector<PixelBox> blocked_;
};

}  // namespace dynamic_icp::drawing
