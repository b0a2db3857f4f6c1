// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/field_summary.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

#include "testing/sensor_calibration.hpp"

namespace dynamic_icp::figures {
namespace {

using Eigen::Index;

TEST(FieldSummary, IsInTheDirectionsAsTheSensorLooksOut) {
  const ShownView view = shown_view({-1.0, 1.5, -0.2, 0.3});
  EXPECT_NEAR(view.left_deg, -28.648, 1e-3) << "azimuth 0.5 rad is to the left";
  EXPECT_NEAR(view.right_deg, 57.296, 1e-3);
  EXPECT_NEAR(view.bottom_deg, -11.459, 1e-3);
  EXPECT_NEAR(view.top_deg, 5.730, 1e-3);
}

TEST(FieldSummary, TellsTheSizesOfTheErrorAndOfItsParts) {
  const std::vector<FieldSummary> sensors = field_summaries(window::half_and_half());
  ASSERT_EQ(sensors.size(), 1U);
  const FieldSummary& sensor = sensors[0];
  EXPECT_NEAR(sensor.sizes.rms_mps, 0.1, 1e-9);
  EXPECT_NEAR(sensor.sizes.largest_mps, 0.1, 1e-9);
  EXPECT_GT(sensor.sizes.median_sigma_mps, 0.01) << "of several parts, each known to 0.01";
  EXPECT_LT(sensor.sizes.median_sigma_mps, 0.03);
  ASSERT_EQ(sensor.parts.size(), 5U);
  const PartSummary& azimuth = sensor.parts[0];
  EXPECT_EQ(azimuth.name, "azimuth");
  EXPECT_EQ(azimuth.scale_mps, 0.1);
  EXPECT_EQ(azimuth.unknowns, 48U);
  EXPECT_NEAR(azimuth.sizes.rms_mps, 0.1, 1e-12);
  EXPECT_NEAR(azimuth.sizes.median_sigma_mps, 0.01, 1e-12);
  EXPECT_EQ(sensor.parts[4].name, "velocity");
  EXPECT_EQ(sensor.parts[4].sizes.largest_mps, 0.0);
}

TEST(FieldSummary, TakesTheMeanOfTheLinesThatACellHolds) {
  window::FieldShape shape;
  shape.views = {{-1.0, 2.0, -0.24, 0.48}};  // rows of 0.06 rad, samples 0.01 rad apart
  shape.line_elevations_rad = {-0.225, -0.195, 0.21};
  const window::DopplerErrorField field(shape);
  const auto n = static_cast<Index>(field.size());
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(n);
  for (const window::DopplerErrorField::Group& group : field.groups()) {
    if (group.name == "line") {
      theta.segment<3>(static_cast<Index>(group.begin)) << 0.02, 0.08, -0.04;
    }
  }
  const auto calibration = window::calibration_of(shape, theta, 1e4 * Eigen::MatrixXd::Identity(n, n));
  const window::ErrorByDirection cells = field_summaries(calibration)[0].cells;
  ASSERT_EQ(cells.error_mps.rows(), 8);
  ASSERT_EQ(cells.error_mps.cols(), 48);
  EXPECT_NEAR(cells.elevations_rad.front(), -0.21, 1e-12);
  EXPECT_NEAR(cells.error_mps(0, 7), 0.05, 1e-12) << "three samples of each line";
  EXPECT_NEAR(cells.error_mps(7, 40), -0.04, 1e-12);
}

TEST(FieldSummary, KeepsTheSensorsOfARigApart) {
  window::FieldShape shape;
  shape.views = {{-1.0, 2.0, -0.2, 0.3}, {1.0, 1.0, -0.2, 0.3}};
  const window::DopplerErrorField field(shape);
  const auto n = static_cast<Index>(field.size());
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(n);
  theta.segment(static_cast<Index>(field.groups()[3].begin), 16).setConstant(0.07);
  const std::vector<FieldSummary> sensors =
      field_summaries(window::calibration_of(shape, theta, 1e4 * Eigen::MatrixXd::Identity(n, n)));
  ASSERT_EQ(sensors.size(), 2U);
  EXPECT_NEAR(sensors[0].sizes.largest_mps, 0.0, 1e-12);
  EXPECT_NEAR(sensors[1].sizes.rms_mps, 0.07, 1e-9);
  ASSERT_EQ(sensors[1].parts.size(), 3U);
  EXPECT_EQ(sensors[1].parts[0].name, "azimuth");
  EXPECT_NEAR(sensors[1].parts[0].sizes.rms_mps, 0.07, 1e-12);
}

TEST(FieldSummary, NeedsPartsThatFit) {
  window::SensorCalibration calibration = window::half_and_half();
  calibration.parts.pop_back();
  EXPECT_THROW(field_summaries(calibration), UsageError);
}

}  // namespace
}  // namespace dynamic_icp::figures
