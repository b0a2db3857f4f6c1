// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/raw_scan.hpp"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/scan.hpp"

namespace dynamic_icp {
namespace {

/// A point as drivers pack them; nothing in it is aligned to eight bytes.
struct DriverPoint {
  float x, y, z, intensity;
  float range_rate;
};

TEST(ScanView, ReadsTheMessageOfADriverInItsPlace) {
  const std::array<DriverPoint, 2> message = {{{3.0F, 4.0F, 0.0F, 7.0F, -1.5F}, {0.0F, 0.0F, 2.0F, 8.0F, 0.25F}}};
  constexpr std::size_t kStride = sizeof(DriverPoint);
  ScanView view;
  view.stamp = Stamp{9};
  view.points = {Column(&message[0].x, 2, kStride), Column(&message[0].y, 2, kStride),
                 Column(&message[0].z, 2, kStride)};
  view.doppler = Column(&message[0].range_rate, 2, kStride);
  const std::vector<double> times = {0.0, 0.05};
  view.times = times;
  const Scan scan = Scan::from_raw(view);
  ASSERT_EQ(scan.size(), 2u);
  EXPECT_EQ(scan.points()[0], Eigen::Vector3d(3.0, 4.0, 0.0));
  EXPECT_EQ(scan.points()[1], Eigen::Vector3d(0.0, 0.0, 2.0));
  EXPECT_EQ(scan.doppler(), (std::vector<double>{-1.5, 0.25}));
  EXPECT_EQ(scan.times(), times);
  EXPECT_EQ(scan.stamp(), Stamp{9});
}

TEST(ScanView, ColumnsMayLieBackwards) {
  const std::array<double, 4> numbers = {1.0, 2.0, 3.0, 4.0};
  const Column backwards(&numbers[3], 2, -2 * static_cast<std::ptrdiff_t>(sizeof(double)));
  EXPECT_EQ(backwards[0], 4.0);
  EXPECT_EQ(backwards[1], 2.0);
}

RawScan two_points() {
  RawScan raw;
  raw.points = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  raw.doppler = {0.5, 0.25};
  return raw;
}

TEST(ScanView, ShowsTheColumnsOfAScan) {
  RawScan raw = two_points();
  raw.directions = {{0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  raw.channels.line = {3, 4};
  const ScanView view = raw;
  EXPECT_EQ(view.points[1], raw.points[1]);
  EXPECT_EQ(view.directions[1], raw.directions[1]);
  EXPECT_EQ(view.doppler[1], 0.25);
  EXPECT_TRUE(view.times.empty());
  EXPECT_EQ(view.line.data(), raw.channels.line.data()) << "nothing is copied";
}

/// What check_columns says; empty where it is content.
std::string complaint(const ScanView& view) {
  try {
    check_columns(view);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(CheckColumns, NamesWhatDiffersInLength) {
  RawScan raw = two_points();
  EXPECT_EQ(complaint(raw), "");
  raw.doppler.pop_back();
  raw.channels.line = {1};
  EXPECT_EQ(complaint(raw), "scan columns differ in length: 2 points, 1 Doppler values, 1 lines");
}

TEST(CheckColumns, EverySensorHasAMounting) {
  RawScan raw = two_points();
  raw.channels.sensor = {0, 2};
  EXPECT_EQ(complaint(raw), "") << "sensors alone are numbers like any";
  raw.mountings.resize(2, Eigen::Isometry3d::Identity());
  EXPECT_EQ(complaint(raw), "a point is of sensor 2, but the scan has 2 mountings");
  raw.channels.sensor.clear();
  EXPECT_EQ(complaint(raw), "a scan with mountings needs the sensor of each point");
  EXPECT_EQ(complaint(RawScan{}), "");
  raw.channels.sensor = {0, 1};
  raw.mountings[1].translation().z() = std::nan("");
  EXPECT_EQ(complaint(raw), "a mounting has numbers that are not finite");
}

}  // namespace
}  // namespace dynamic_icp
