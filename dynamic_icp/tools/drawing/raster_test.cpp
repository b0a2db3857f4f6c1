// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/drawing/raster.hpp"

#include <cstdint>

#include <gtest/gtest.h>
#include <png.h>

namespace dynamic_icp::drawing {
namespace {

TEST(Raster, PngHoldsThePixels) {
  Raster raster(5, 3, {10, 20, 30});
  raster.set(4, 0, {255, 0, 0});
  raster.set(0, 2, {0, 0, 255});
  const std::string bytes = png(raster);

  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0) << image.message;
  image.format = PNG_FORMAT_RGB;
  ASSERT_EQ(image.width, 5U);
  ASSERT_EQ(image.height, 3U);
  std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(image));
  ASSERT_NE(png_image_finish_read(&image, nullptr, rgb.data(), 0, nullptr), 0) << image.message;
  for (std::size_t y = 0; y < 3; ++y) {
    for (std::size_t x = 0; x < 5; ++x) {
      const std::size_t i = 3 * (5 * y + x);
      EXPECT_EQ((Rgb{rgb[i], rgb[i + 1], rgb[i + 2]}), raster.at(x, y)) << x << " " << y;
    }
  }
}

TEST(Raster, PixelsOutsideAreRefused) {
  Raster raster(2, 2, {});
  EXPECT_THROW(raster.set(0, 2, {}), std::out_of_range);
  EXPECT_THROW((void)raster.at(1, 2), std::out_of_range);
}

}  // namespace
}  // namespace dynamic_icp::drawing
