// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/base/scan.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace dynamic_icp {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

RawScan three_points() {
  RawScan raw;
  raw.stamp = Stamp{42};
  raw.points = {{3.0, 4.0, 0.0}, {0.0, -2.0, 0.0}, {1.0, 2.0, 2.0}};
  raw.doppler = {-1.0, 0.5, 2.0};
  raw.times = {0.0, 0.01, 0.02};
  return raw;
}

TEST(Scan, DirectionsAreUnitLinesOfSight) {
  const Scan scan = Scan::from_raw(three_points());
  ASSERT_EQ(scan.size(), 3u);
  EXPECT_TRUE(scan.directions()[0].isApprox(Eigen::Vector3d(0.6, 0.8, 0.0), 1e-15));
  EXPECT_TRUE(scan.directions()[1].isApprox(Eigen::Vector3d(0.0, -1.0, 0.0), 1e-15));
  EXPECT_EQ(scan.stamp(), Stamp{42});
}

TEST(Scan, GivenDirectionsAreKeptAndNormalised) {
  RawScan raw = three_points();
  raw.directions = {{0.0, 0.0, 2.0}, {5.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  const Scan scan = Scan::from_raw(raw);
  EXPECT_EQ(scan.directions()[0], Eigen::Vector3d(0.0, 0.0, 1.0));
  EXPECT_EQ(scan.points()[0], Eigen::Vector3d(3.0, 4.0, 0.0));
}

TEST(Scan, DropsAndCountsWhatIsNotAMeasurement) {
  RawScan raw;
  raw.points = {{1, 0, 0}, {kNan, 0, 0}, {0, kInfinity, 0}, {0, 0, 0}, {1, 1, 1}, {2, 0, 0}};
  raw.doppler = {0.0, 0.0, 0.0, 0.0, kNan, 1.0};
  Scan::Dropped dropped;
  const Scan scan = Scan::from_raw(raw, &dropped);
  EXPECT_EQ(scan.size(), 2u);
  EXPECT_EQ(dropped.non_finite, 3u);
  EXPECT_EQ(dropped.zero_range, 1u);
  EXPECT_EQ(scan.records(), (std::vector<std::uint32_t>{0, 5}));
  EXPECT_FALSE(scan.has_times());
}

TEST(Scan, DropsNonFiniteTimes) {
  RawScan raw = three_points();
  raw.times[1] = kNan;
  const Scan scan = Scan::from_raw(raw);
  EXPECT_EQ(scan.records(), (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(scan.times(), (std::vector<double>{0.0, 0.02}));
}

TEST(Scan, SelectKeepsRowsTogether) {
  const Scan scan = Scan::from_raw(three_points());
  const std::vector<std::uint32_t> rows = {2, 0};
  const Scan selected = scan.select(rows);
  ASSERT_EQ(selected.size(), 2u);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_EQ(selected.points()[k], scan.points()[rows[k]]);
    EXPECT_EQ(selected.directions()[k], scan.directions()[rows[k]]);
    EXPECT_EQ(selected.doppler()[k], scan.doppler()[rows[k]]);
    EXPECT_EQ(selected.times()[k], scan.times()[rows[k]]);
    EXPECT_EQ(selected.records()[k], rows[k]);
  }
  EXPECT_EQ(selected.stamp(), scan.stamp());
}

TEST(Scan, DisplacingAPointLeavesItsMeasurement) {
  Scan scan = Scan::from_raw(three_points());
  scan.displace(1, {10.0, 0.0, 0.0});
  EXPECT_EQ(scan.points()[1], Eigen::Vector3d(10.0, -2.0, 0.0));
  EXPECT_EQ(scan.directions()[1], Eigen::Vector3d(0.0, -1.0, 0.0));
  EXPECT_EQ(scan.doppler()[1], 0.5);
}

TEST(Scan, RefusesColumnsOfDifferentLength) {
  RawScan raw = three_points();
  raw.doppler.pop_back();
  EXPECT_THROW(Scan::from_raw(raw), std::invalid_argument);
}

TEST(Scan, EmptyIsAScan) {
  const Scan scan = Scan::from_raw(RawScan{});
  EXPECT_TRUE(scan.empty());
  EXPECT_TRUE(scan.select({}).empty());
}

}  // namespace
}  // namespace dynamic_icp
