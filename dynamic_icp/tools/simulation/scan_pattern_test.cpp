// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/scan_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace dynamic_icp::simulation {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

FmcwLidarConfig small() {
  FmcwLidarConfig config;
  config.columns = 12;
  config.rows = 4;
  config.vertical_center_deg = -3.0;
  return config;
}

TEST(ScanPattern, ColumnsCoverTheFieldOfViewEvenly) {
  FmcwLidarConfig config = small();
  config.sweep_s = 0.06;
  const ScanPattern pattern = scan_pattern(config);
  ASSERT_EQ(pattern.size(), 12U);
  for (std::size_t column = 0; column < pattern.size(); ++column) {
    EXPECT_NEAR(pattern[column].time_s, 0.005 * static_cast<double>(column), 1e-15);
    ASSERT_EQ(pattern[column].rays.size(), 4U);
    for (std::size_t row = 0; row < 4; ++row) {
      const PatternRay& ray = pattern[column].rays[row];
      EXPECT_NEAR(ray.azimuth_rad * kDegrees, 55.0 - 10.0 * static_cast<double>(column), 1e-12);
      EXPECT_NEAR(ray.elevation_rad * kDegrees, -3.0 + 7.2 - 4.8 * static_cast<double>(row), 1e-12);
      EXPECT_EQ(ray.line, row);
    }
  }
}

TEST(ScanPattern, RowsAreSweptOneAfterTheOther) {
  FmcwLidarConfig config = small();
  config.sweep_s = 0.06;
  config.row_by_row = true;
  const ScanPattern pattern = scan_pattern(config);
  ASSERT_EQ(pattern.size(), 12U);
  std::size_t i = 0;
  for (std::size_t firing = 0; firing < pattern.size(); ++firing) {
    EXPECT_NEAR(pattern[firing].time_s, 0.005 * static_cast<double>(firing), 1e-15);
    for (const PatternRay& ray : pattern[firing].rays) {
      EXPECT_EQ(ray.line, i / 12);
      EXPECT_NEAR(ray.azimuth_rad * kDegrees, 55.0 - 10.0 * static_cast<double>(i % 12), 1e-12);
      ++i;
    }
  }
  EXPECT_EQ(i, 48U);
}

TEST(ScanPattern, InterleavedBeamsSweepBandsOfTheirOwn) {
  FmcwLidarConfig config = small();
  config.rows = 8;
  config.sweep_s = 0.06;
  config.row_by_row = true;
  config.beams = 2;
  const ScanPattern pattern = scan_pattern(config);
  ASSERT_EQ(pattern.size(), 12U);
  std::vector<double> begin(8, 1.0), end(8, 0.0);
  for (const Firing& firing : pattern) {
    ASSERT_EQ(firing.rays.size(), 8U);
    for (std::size_t i = 0; i < 8; ++i) {
      const PatternRay& ray = firing.rays[i];
      EXPECT_EQ(ray.beam, ray.line / 4);
      EXPECT_NEAR(ray.elevation_rad * kDegrees, -3.0 + 8.4 - 2.4 * ray.line, 1e-12);
      begin[ray.line] = std::min(begin[ray.line], firing.time_s);
      end[ray.line] = std::max(end[ray.line], firing.time_s);
      EXPECT_EQ(firing.rays[i ^ 1U].line, ray.line < 4 ? ray.line + 4 : ray.line - 4) << "at once, half the view away";
    }
  }
  for (std::size_t line = 0; line < 8; ++line) {  // a quarter of the sweep each
    EXPECT_NEAR(begin[line], 0.015 * static_cast<double>(line % 4), 1e-12);
    EXPECT_NEAR(end[line], 0.015 * static_cast<double>(line % 4) + 0.010, 1e-12);
  }
}

TEST(ScanPattern, BeamsTakeTheLinesInTurnAndFacesPartsOfTheAzimuth) {
  FmcwLidarConfig config = small();
  config.beams = 3;
  config.faces = 4;
  const ScanPattern pattern = scan_pattern(config);
  for (std::size_t column = 0; column < 12; ++column) {
    for (const PatternRay& ray : pattern[column].rays) {
      EXPECT_EQ(ray.beam, ray.line % 3);
      EXPECT_EQ(ray.face, column / 3);
    }
  }
  config.face_per_scan = true;
  EXPECT_EQ(scan_pattern(config)[11].rays[0].face, 0);
}

TEST(ScanPattern, InstantScansHaveOneTime) {
  for (const Firing& firing : scan_pattern(small())) {
    EXPECT_EQ(firing.time_s, 0.0);
  }
}

TEST(ScanPattern, DirectionIsAUnitVectorWithTheseAngles) {
  const Eigen::Vector3d u = direction(0.7, -0.3);
  EXPECT_NEAR(u.norm(), 1.0, 1e-15);
  EXPECT_NEAR(std::atan2(u.y(), u.x()), 0.7, 1e-15);
  EXPECT_NEAR(std::asin(u.z()), -0.3, 1e-15);
}

}  // namespace
}  // namespace dynamic_icp::simulation
