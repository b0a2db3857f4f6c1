// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/calibration_file.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

#include "testing/sample_run.hpp"

namespace dynamic_icp::runs {
namespace {

window::SensorCalibration some_calibration() {
  window::SensorCalibration calibration;
  calibration.shape = {{{-1.05, 2.1, -0.17, 0.34}}, {-0.1, 0.0, 0.125}, 8, 0.31234567890123, 4.5};
  calibration.parts = {{"azimuth", 0.11, {0.1, -0.2}, {0.003, 0.004}}, {"velocity", 0.165, {1.0 / 3.0}, {0.05}}};
  calibration.information = {{2.5e6}, {-1e-9, 3.0}, {0.1, 0.2, 1e5}};
  calibration.gradient = {1e-3, -7.0, 0.0};
  calibration.stamp_sigma_s = 5.1e-4;
  calibration.period_sigma_s = 2.5e-5;
  calibration.scan_error_mps = 0.02;
  return calibration;
}

class CalibrationFile : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) {
    folder_.write("calibration.yaml", text);
    return folder_.path() / "calibration.yaml";
  }

  /// The message about a file where `from` stands as `to`.
  std::string refused(const std::string& from, const std::string& to) {
    std::string text = calibration_text(some_calibration());
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    try {
      read_calibration(write(text));
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  }

  TestFolder folder_;
};

TEST_F(CalibrationFile, ReadsBackTheSameNumbers) {
  const window::SensorCalibration written = some_calibration();
  const window::SensorCalibration read = read_calibration(write(calibration_text(written)));
  EXPECT_EQ(read.shape.line_elevations_rad, written.shape.line_elevations_rad);
  EXPECT_EQ(read.shape.faces, 8U);
  EXPECT_EQ(read.shape.intensity_mean, written.shape.intensity_mean);
  EXPECT_EQ(read.shape.intensity_scale, 4.5);
  ASSERT_EQ(read.shape.views.size(), 1U);
  EXPECT_EQ(read.shape.views[0].azimuth_first, -1.05);
  EXPECT_EQ(read.shape.views[0].azimuth_span, 2.1);
  EXPECT_EQ(read.shape.views[0].elevation_first, -0.17);
  EXPECT_EQ(read.shape.views[0].elevation_span, 0.34);
  ASSERT_EQ(read.parts.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(read.parts[k].name, written.parts[k].name);
    EXPECT_EQ(read.parts[k].scale_mps, written.parts[k].scale_mps);
    EXPECT_EQ(read.parts[k].error_mps, written.parts[k].error_mps);
    EXPECT_EQ(read.parts[k].sigma_mps, written.parts[k].sigma_mps);
  }
  EXPECT_EQ(read.information, written.information);
  EXPECT_EQ(read.gradient, written.gradient);
  EXPECT_EQ(read.stamp_sigma_s, 5.1e-4);
  EXPECT_EQ(read.period_sigma_s, 2.5e-5);
  EXPECT_EQ(read.scan_error_mps, 0.02);
}

// The lines of a rig are not told apart.
TEST_F(CalibrationFile, ReadsBackOneWithoutLines) {
  window::SensorCalibration written = some_calibration();
  written.shape.line_elevations_rad.clear();
  EXPECT_EQ(read_calibration(write(calibration_text(written))).shape.lines(), 0U);
  EXPECT_NE(refused("[-0.1, 0, 0.125]", "[-0.1, x]").find("line 4"), std::string::npos);
  EXPECT_NE(refused("line_elevations_rad: [-0.1, 0, 0.125]\n", "").find("line_elevations_rad"), std::string::npos);
}

TEST_F(CalibrationFile, RefusesWhatDoesNotFit) {
  EXPECT_NE(refused("line_elevations_rad: [-0.1, 0, 0.125]\n", "").find("expected calibration.yaml of a run"),
            std::string::npos);
  EXPECT_NE(refused("version: 1", "version: 2").find("calibration.yaml: line 3"), std::string::npos);
  EXPECT_NE(refused("scale_mps: 0.11", "scale_mps: -0.11").find("scale_mps"), std::string::npos);
  EXPECT_NE(refused("sigma_mps: [0.05]", "sigma_mps: [0.05, 1]").find("sigma_mps"), std::string::npos);
  EXPECT_NE(refused("[0.1, 0.2, 100000]", "[0.1, 0.2]").find("row"), std::string::npos);
  EXPECT_NE(refused("[0.1, -0.2]", "[0.1, .nan]").find("error_mps"), std::string::npos);
  EXPECT_NE(refused("faces: 8", "faces: 8\nline: 3").find("'line'"), std::string::npos);
}

}  // namespace
}  // namespace dynamic_icp::runs
