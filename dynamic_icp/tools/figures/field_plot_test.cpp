// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/field_plot.hpp"

#include <string>

#include <gtest/gtest.h>

#include "dynamic_icp/recording/formats/base64.hpp"
#include "dynamic_icp/tools/drawing/raster.hpp"

#include "testing/sensor_calibration.hpp"

namespace dynamic_icp::figures {
namespace {

TEST(FieldPlot, ShowsTheErrorAsTheSensorLooksOut) {
  for (const drawing::Ground ground : {drawing::Ground::kLight, drawing::Ground::kDark}) {
    const std::string svg = field_plot(window::half_and_half(), drawing::theme(ground)).document();
    drawing::Raster expected(96, 24, drawing::diverging_colour(1.0, ground));
    for (std::size_t x = 48; x < expected.width(); ++x) {
      for (std::size_t y = 0; y < expected.height(); ++y) {
        expected.set(x, y, drawing::diverging_colour(-1.0, ground));
      }
    }
    EXPECT_NE(svg.find(formats::base64(drawing::png(expected))), std::string::npos) << "left is left";
    EXPECT_NE(svg.find("-100 mm/s"), std::string::npos);
    EXPECT_NE(svg.find("standard deviation"), std::string::npos);
  }
}

}  // namespace
}  // namespace dynamic_icp::figures
