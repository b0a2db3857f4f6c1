// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/field_parts_plot.hpp"

#include <string>

#include <gtest/gtest.h>

#include "testing/sensor_calibration.hpp"

namespace dynamic_icp::figures {
namespace {

/// Of a sensor with so many lines and faces, whose Doppler errs by nothing.
std::string picture_of(std::size_t lines, std::size_t faces) {
  window::FieldShape shape;
  shape.views = {{-1.0, 2.0, -0.2, 0.3}};
  for (std::size_t line = 0; line < lines; ++line) {
    shape.line_elevations_rad.push_back(0.01 * static_cast<double>(line));
  }
  shape.faces = faces;
  const auto n = static_cast<Eigen::Index>(window::DopplerErrorField(shape).size());
  const window::SensorCalibration calibration =
      window::calibration_of(shape, Eigen::VectorXd::Zero(n), 1e4 * Eigen::MatrixXd::Identity(n, n));
  return field_parts_plot(calibration, drawing::theme(drawing::Ground::kLight)).document();
}

bool holds(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

TEST(FieldPartsPlot, HasAPanelForEachPartThatTheSensorHas) {
  const std::string all = picture_of(5, 3);
  EXPECT_TRUE(holds(all, "By line") && holds(all, "By face") && holds(all, "By range"));
  const std::string plain = picture_of(0, 1);
  EXPECT_FALSE(holds(plain, "By line") || holds(plain, "By face"));
  EXPECT_TRUE(holds(plain, "By range"));
}

}  // namespace
}  // namespace dynamic_icp::figures
