// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/channel.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace dynamic_icp::formats {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Three points; the second is no measurement.
RawScan three_points() {
  RawScan scan;
  scan.points = {{1, 2, 3}, {kNan, 0, 0}, {4, 5, 6}};
  scan.doppler = {-1, -2, -3};
  return scan;
}

TEST(Channel, NumbersComeIntoTheirPlace) {
  RawScan scan = three_points();
  EXPECT_EQ(set_channel(scan, Channel::kSensor, std::vector<double>{0, 1, 255}), "");
  EXPECT_EQ(set_channel(scan, Channel::kLine, std::vector<double>{0, 1, 65535}), "");
  EXPECT_EQ(set_channel(scan, Channel::kFace, std::vector<double>{5, 0, 1}), "");
  EXPECT_EQ(set_channel(scan, Channel::kIntensity, std::vector<double>{-57.5, 0, 8191}), "");
  EXPECT_EQ(set_channel(scan, Channel::kReturnNumber, std::vector<double>{0, 0, 1}), "");
  EXPECT_EQ(scan.channels.sensor, (Bytes{0, 1, 255}));
  EXPECT_EQ(scan.channels.line, (std::vector<std::uint16_t>{0, 1, 65535}));
  EXPECT_EQ(scan.channels.face, (Bytes{5, 0, 1}));
  EXPECT_EQ(scan.channels.intensity, (std::vector<float>{-57.5F, 0, 8191}));
  EXPECT_EQ(scan.channels.return_number, (Bytes{0, 0, 1}));
  EXPECT_TRUE(scan.is_unusable.empty());
}

TEST(Channel, WhatDoesNotFitIsLeftOutWithTheReason) {
  const std::vector<std::pair<double, std::string>> wrong = {
      {65536, "holds 65536 at point 2"}, {-1, "holds -1"}, {0.5, "holds 0.5"}, {kNan, "holds nan"}, {1e300, "1e+300"}};
  for (const auto& [value, reason] : wrong) {
    RawScan scan = three_points();
    const std::string said = set_channel(scan, Channel::kLine, std::vector<double>{1, 2, value});
    EXPECT_NE(said.find(reason), std::string::npos) << said;
    EXPECT_NE(said.find("whole numbers from 0 to 65535"), std::string::npos) << said;
    EXPECT_TRUE(scan.channels.line.empty());
  }
  RawScan scan = three_points();
  EXPECT_NE(set_channel(scan, Channel::kSensor, std::vector<double>{1, 2, 256}), "");
  EXPECT_NE(set_channel(scan, Channel::kIntensity, std::vector<double>{1, 2}), "") << "one is missing";
  EXPECT_TRUE(scan.channels.sensor.empty() && scan.channels.intensity.empty());
}

TEST(Channel, OfAPointThatIsNoMeasurementTheNumberDoesNotCount) {
  RawScan scan = three_points();
  EXPECT_EQ(set_channel(scan, Channel::kLine, std::vector<double>{7, kNan, 9}), "");
  EXPECT_EQ(scan.channels.line, (std::vector<std::uint16_t>{7, 0, 9}));
}

TEST(Channel, FlagsOfSeveralColumnsAddUp) {
  RawScan scan = three_points();
  EXPECT_EQ(set_channel(scan, Channel::kValid, std::vector<double>{1, 1, 0}), "");
  EXPECT_EQ(scan.is_unusable, (Bytes{0, 0, 1}));
  EXPECT_EQ(set_channel(scan, Channel::kInvalid, std::vector<double>{0, 4, 0}), "");
  EXPECT_EQ(scan.is_unusable, (Bytes{0, 1, 1}));
  RawScan other = three_points();
  EXPECT_EQ(set_channel(other, Channel::kValid, std::vector<double>{kNan, 1, 1}), "");
  EXPECT_EQ(set_channel(other, Channel::kInvalid, std::vector<double>{0, 0, kNan}), "");
  EXPECT_EQ(other.is_unusable, (Bytes{1, 0, 1}));
}

}  // namespace
}  // namespace dynamic_icp::formats
