// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/drawing/raster.hpp"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include <png.h>

namespace dynamic_icp::drawing {

Raster::Raster(std::size_t width, std::size_t height, Rgb colour)
    : width_(std::max<std::size_t>(1, width)), pixels_(width_ * std::max<std::size_t>(1, height), colour) {}

std::string png(const Raster& raster) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(raster.width());
  image.height = static_cast<png_uint_32>(raster.height());
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> rgb;
  rgb.reserve(3 * raster.width() * raster.height());
  for (std::size_t y = 0; y < raster.height(); ++y) {
    for (std::size_t x = 0; x < raster.width(); ++x) {
      const Rgb colour = raster.at(x, y);
      rgb.insert(rgb.end(), {colour.red, colour.green, colour.blue});
    }
  }
  png_alloc_size_t size = 0;
  std::string bytes;
  if (png_image_write_get_memory_size(image, size, 0, rgb.data(), 0, nullptr) != 0) {
    bytes.resize(size);
    if (png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr) != 0) {
      bytes.resize(size);
      return bytes;
    }
  }
  throw std::runtime_error(std::string("libpng cannot make a picture: ") + image.message);
}

}  // namespace dynamic_icp::drawing
