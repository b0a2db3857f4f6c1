// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dynamic_icp/tools/drawing/colour_map.hpp"

namespace dynamic_icp::drawing {

/// A picture of pixels, row by row from the top.
class Raster {
 public:
  /// All pixels in one colour. At least 1 x 1.
  Raster(std::size_t width, std::size_t height, Rgb colour);

  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] std::size_t height() const { return pixels_.size() / width_; }

  [[nodiscard]] Rgb at(std::size_t x, std::size_t y) const { return pixels_.at(y * width_ + x); }
  void set(std::size_t x, std::size_t y, Rgb colour) { pixels_.at(y * width_ + x) = colour; }

 private:
  std::size_t width_;
  std::vector<Rgb> pixels_;
};

/// The picture as the bytes of a PNG file.
std::string png(const Raster& raster);

}  // namespace dynamic_icp::drawing
