// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/field_plot.hpp"

#include <string>

#include <gtest/gtest.h>

#include "dynamic_icp/tools/drawing/raster.hpp"

#include "testing/sensor_calibration.hpp"

namespace dynamic_icp::figures {
namespace {

using Eigen::Index;

/// 0.1 m/s too much on the left, too little on the right.
window::SensorCalibration half_and_half() {
  window::FieldShape shape;
  shape.views = {{-1.0, 2.0, -0.2, 0.3}};
  const window::DopplerErrorField field(shape);
  const auto n = static_cast<Index>(field.size());
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(n);
  for (const window::DopplerErrorField::Group& group : field.groups()) {
    if (group.name == "azimuth") {
      const auto half = static_cast<Index>(group.size() / 2);
      theta.segment(static_cast<Index>(group.begin), half).setConstant(-0.1);
      theta.segment(static_cast<Index>(group.begin) + half, half).setConstant(0.1);
    }
  }
  return window::calibration_of(shape, theta, 1e4 * Eigen::MatrixXd::Identity(n, n));
}

TEST(FieldPlot, ShowsTheErrorAsTheSensorLooksOut) {
  for (const drawing::Ground ground : {drawing::Ground::kLight, drawing::Ground::kDark}) {
    const std::string svg = field_plot(half_and_half(), drawing::theme(ground)).document();
    drawing::Raster expected(96, 24, drawing::diverging_colour(1.0, ground));
    for (std::size_t x = 48; x < expected.width(); ++x) {
      for (std::size_t y = 0; y < expected.height(); ++y) {
        expected.set(x, y, drawing::diverging_colour(-1.0, ground));
      }
    }
    EXPECT_NE(svg.find(drawing::base64(drawing::png(expected))), std::string::npos) << "left is left";
    EXPECT_NE(svg.find("-0.100 m/s"), std::string::npos);
    EXPECT_NE(svg.find("standard deviation"), std::string::npos);
  }
}

}  // namespace
}  // namespace dynamic_icp::figures
