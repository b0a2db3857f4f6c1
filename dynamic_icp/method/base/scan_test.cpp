// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/scan.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/scan_limits.hpp"

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

TEST(Scan, DropsAndCountsWhatNoSensorMeasures) {
  RawScan raw;
  for (int i = 0; i < 100; ++i) {
    raw.points.emplace_back(10.0, i, 1.0);
    raw.doppler.push_back(1.0);
    raw.times.push_back(1e-3 * i);
  }
  raw.points[10].x() = 1e200;
  raw.points[11].z() = -2.0 * kMaxCoordinate_m;
  raw.doppler[20] = 1e155;
  raw.doppler[21] = -2.0 * kMaxDoppler_mps;
  raw.times[30] = 1e30;
  raw.times[31] = 10.0;  // such a sweep may be, but not with all other points in its first tenth of a second
  raw.times[32] = kNan;
  Scan::Dropped dropped;
  const Scan scan = Scan::from_raw(raw, &dropped);
  EXPECT_EQ(dropped.implausible, 6u);
  EXPECT_EQ(dropped.non_finite, 1u);
  EXPECT_EQ(scan.size(), 93u);
  EXPECT_EQ(dropped.total(), 7u);
}

TEST(Scan, DropsAndCountsWhatTheSensorFlags) {
  RawScan raw = three_points();
  raw.is_unusable = {0, 1, 0};
  raw.points[2].x() = kNan;
  Scan::Dropped dropped;
  const Scan scan = Scan::from_raw(raw, &dropped);
  EXPECT_EQ(dropped.flagged, 1u);
  EXPECT_EQ(dropped.non_finite, 1u);
  EXPECT_EQ(dropped.total(), 2u);
  EXPECT_EQ(scan.records(), (std::vector<std::uint32_t>{0}));
}

TEST(Scan, ChannelsStayWithTheirPoints) {
  RawScan raw = three_points();
  raw.channels = {{0, 1, 0}, {5, 6, 700}, {1, 2, 3}, {0.5F, 0.25F, 0.125F}, {0, 1, 2}};
  raw.points[0].setZero();
  const Scan scan = Scan::from_raw(raw);
  ASSERT_EQ(scan.size(), 2u);
  EXPECT_EQ(scan.channels().line, (std::vector<std::uint16_t>{6, 700}));
  EXPECT_EQ(scan.channels().sensor, (std::vector<std::uint8_t>{1, 0}));
  const Scan selected = scan.select(std::vector<std::uint32_t>{1});
  EXPECT_EQ(selected.channels().face, (std::vector<std::uint8_t>{3}));
  EXPECT_EQ(selected.channels().intensity, (std::vector<float>{0.125F}));
  EXPECT_EQ(selected.channels().return_number, (std::vector<std::uint8_t>{2}));
  EXPECT_TRUE(Scan::from_raw(three_points()).channels().line.empty());
}

TEST(Scan, AnIntensityThatIsNoNumberIsNone) {
  RawScan raw;
  raw.points = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}, {7.0, 8.0, 9.0}};
  raw.doppler = {0.0, 0.0, 0.0};
  raw.channels.intensity = {std::numeric_limits<float>::quiet_NaN(), 0.5F, -std::numeric_limits<float>::infinity()};
  Scan::Dropped dropped;
  const Scan scan = Scan::from_raw(raw, &dropped);
  EXPECT_EQ(scan.size(), 3U) << "where they are and how fast is known";
  EXPECT_EQ(dropped.total(), 0U);
  EXPECT_EQ(scan.channels().intensity, (std::vector<float>{0.0F, 0.5F, 0.0F}));
}

TEST(Scan, AScanUsedAgainForgetsTheChannelsOfTheLast) {
  RawScan raw = three_points();
  raw.channels.line = {1, 2, 3};
  raw.channels.sensor = {0, 0, 0};
  raw.mountings = {Eigen::Isometry3d::Identity()};
  Scan scan = Scan::from_raw(raw);
  scan.assign(three_points(), {}, Workers(1));
  EXPECT_TRUE(scan.channels().line.empty());
  EXPECT_TRUE(scan.channels().sensor.empty());
  EXPECT_TRUE(scan.mountings().empty());
}

TEST(Scan, LinesOfSightBeginAtTheSensorThatMeasured) {
  RawScan raw = three_points();
  raw.channels.sensor = {0, 1, 1};
  raw.mountings.assign(2, Eigen::Isometry3d::Identity());
  raw.mountings[0].translation() = Eigen::Vector3d(3.0, 0.0, 0.0);
  raw.mountings[1].translation() = Eigen::Vector3d(1.0, 2.0, 0.0);
  const Scan scan = Scan::from_raw(raw);
  EXPECT_TRUE(scan.directions()[0].isApprox(Eigen::Vector3d::UnitY(), 1e-15));
  EXPECT_TRUE(scan.directions()[2].isApprox(Eigen::Vector3d::UnitZ(), 1e-15));
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(0.0, 0.0, 7.0);
  EXPECT_EQ(scan.transformed(T).mountings()[1].translation(), Eigen::Vector3d(1.0, 2.0, 7.0));
}

TEST(Scan, TransformedMovesPointsAndTurnsLinesOfSight) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(0.0, 0.0, 7.0);
  const Scan scan = Scan::from_raw(three_points());
  const Scan moved = scan.transformed(T);
  EXPECT_TRUE(moved.points()[0].isApprox(Eigen::Vector3d(-4.0, 3.0, 7.0), 1e-14));
  EXPECT_TRUE(moved.directions()[0].isApprox(Eigen::Vector3d(-0.8, 0.6, 0.0), 1e-14));
  EXPECT_EQ(moved.doppler(), scan.doppler());
  EXPECT_EQ(moved.times(), scan.times());
  EXPECT_EQ(moved.records(), scan.records());
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

TEST(Scan, TakesOverAnotherInItsPlace) {
  // A long scan with times and gaps, then a short one without times: nothing of the first may be left.
  RawScan first;
  for (int i = 0; i < 10'000; ++i) {
    const double x = i % 7 == 0 ? std::nan("") : 1.0 + i % 90;
    first.points.emplace_back(x, 2.0, 0.5);
    first.doppler.push_back(i);
    first.times.push_back(1e-5 * i);
  }
  RawScan second;
  second.points = {{3.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {100.0, 0.0, 0.0}, {0.0, 4.0, 0.0}};
  second.doppler = {1.0, 2.0, 3.0, 4.0};
  const Workers workers(3);
  const Scan::RangeLimits limits{2.5, 60.0};
  Scan reused = Scan::from_raw(first, limits, workers);
  EXPECT_EQ(reused.size(), Scan::from_raw(first, limits, Workers(1)).size());
  for (std::size_t row = 0; row < reused.size(); ++row) {
    ASSERT_EQ(reused.points()[row], first.points[reused.records()[row]]);
    ASSERT_EQ(reused.times()[row], first.times[reused.records()[row]]);
    ASSERT_NEAR((reused.directions()[row] * reused.points()[row].norm() - reused.points()[row]).norm(), 0.0, 1e-12);
  }
  Scan::Dropped dropped;
  reused.assign(second, limits, workers, &dropped);
  EXPECT_EQ(reused.records(), (std::vector<std::uint32_t>{0, 3}));
  EXPECT_FALSE(reused.has_times());
  EXPECT_EQ(reused.doppler(), (std::vector<double>{1.0, 4.0}));
  EXPECT_EQ(dropped.zero_range, 1u);
  EXPECT_EQ(dropped.out_of_range, 1u);
  EXPECT_EQ(dropped.non_finite, 0u);
}

}  // namespace
}  // namespace dynamic_icp
