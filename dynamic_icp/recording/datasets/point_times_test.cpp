// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/point_times.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace dynamic_icp::datasets {
namespace {

template <class Number>
formats::NpyArray column(const std::vector<Number>& values) {
  return formats::npy_array<Number>({values.size()}, values);
}

template <class Number>
std::vector<double> read(std::string_view name, const std::vector<Number>& values, Stamp stamp = {}) {
  return times_after(stamp, column(values), time_unit(name, column(values), 0.1));
}

void expect_near(const std::vector<double>& times, const std::vector<double>& expected, double tolerance) {
  ASSERT_EQ(times.size(), expected.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_NEAR(times[i], expected[i], tolerance) << i;
  }
}

TEST(PointTimes, WhatSpansAPeriodSaysItsUnit) {
  expect_near(read<float>("time", {0.0F, 99.5F}), {0, 0.0995}, 1e-8);
  expect_near(read<std::int32_t>("time", {0, 99}), {0, 0.099}, 1e-12);
  expect_near(read<std::uint32_t>("time", {0, 98'765}), {0, 0.098765}, 1e-12);
  expect_near(read<std::uint32_t>("time", {0, 98'765'432}), {0, 0.098765432}, 1e-12);
}

TEST(PointTimes, IntegersAreNanoseconds) {
  expect_near(read<std::int32_t>("t", {-5, 0, 99'999'999}), {-5e-9, 0, 0.099999999}, 1e-15);
  expect_near(read<std::uint32_t>("time", {4'000'000'000U}), {4.0}, 1e-15);
}

TEST(PointTimes, FloatsAreSecondsOrNanosecondsBySpan) {
  expect_near(read<float>("time", {0.0F, 0.0625F}), {0, 0.0625}, 0);
  expect_near(read<float>("time", {0.0F, 1e8F}), {0, 0.1}, 1e-12);
  expect_near(read<double>("time", {-0.05, 0.05}), {-0.05, 0.05}, 0);
  // 100 000 of nothing but microseconds make a period of 0.1 s.
  expect_near(read<float>("time", {0.0F, 98'765.0F}), {0, 0.098765}, 1e-12);
  EXPECT_EQ(time_unit("time", column<float>({0.0F, 98'765.0F}), 10.0).ns, 1);
}

TEST(PointTimes, NamesWithUnitsGoFirstAndNeedNoWords) {
  expect_near(read<float>("time_offset_ns", {0.0F, 5.0F}), {0, 5e-9}, 1e-20);
  expect_near(read<float>("nanosecs_since_frame", {0.0F, 5.0F}), {0, 5e-9}, 1e-20);
  expect_near(read<float>("timestamp_nsecs", {0.0F, 5.0F}), {0, 5e-9}, 1e-20);
  expect_near(read<std::int32_t>("offset_us", {7}), {7e-6}, 1e-15);
  expect_near(read<std::int32_t>("offset_ms", {7}), {7e-3}, 1e-15);
  EXPECT_TRUE(time_unit("time_offset_ns", column<float>({0.0F}), 0.1).assumption.empty());
  const std::string told = time_unit("time", column<float>({0.25F, 0.5F}), 0.1).assumption;
  EXPECT_NE(told.find("'time' are taken as seconds after the stamp"), std::string::npos) << told;
  EXPECT_NE(told.find("0.25 to 0.5"), std::string::npos) << told;
}

TEST(PointTimes, UnixTimesAreExactWhereTheyAreIntegers) {
  const Stamp stamp{1'724'479'779'384'729'500};
  expect_near(read<std::uint64_t>("timestamp", {1'724'479'779'384'729'506U, 1'724'479'779'400'000'000U}, stamp),
              {6e-9, 0.0152705}, 1e-17);
  expect_near(read<std::int64_t>("timestamp", {1'724'479'779'384'730}, stamp), {5e-7}, 1e-15);  // microseconds
  expect_near(read<double>("timestamp", {1'724'479'779.5}, stamp), {0.1152705}, 1e-6);
  expect_near(read<double>("timestamp", {1.7244797795e18}, stamp), {0.1152705}, 1e-6);
}

TEST(PointTimes, UnixTimesFarFromAMereIndexBeginWithTheScan) {
  expect_near(read<std::uint64_t>("t", {1'724'479'779'384'729'506U, 1'724'479'779'384'729'500U}), {6e-9, 0}, 1e-17);
  expect_near(read<double>("t", {1'724'479'779.5, 1'724'479'779.25}), {0.25, 0}, 0);
}

TEST(PointTimes, WhatIsNotFiniteIsPassedOn) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> times = read<double>("time", {nan, 0.5, std::numeric_limits<double>::infinity()});
  EXPECT_TRUE(std::isnan(times[0]));
  EXPECT_EQ(times[1], 0.5);
  EXPECT_TRUE(read<double>("time", {nan}).size() == 1 && read<float>("time", {}).empty());
}

TEST(PointTimes, AnyIntegersAreDefined) {
  const auto min = std::numeric_limits<std::int64_t>::min();
  const auto max = std::numeric_limits<std::int64_t>::max();
  const TimeUnit unix{1'000'000'000, true, {}};
  EXPECT_EQ(times_after(Stamp{min}, column<std::int64_t>({min, max, 0}), unix).size(), 3u);
  EXPECT_EQ(times_after(Stamp{max}, column<std::int64_t>({max, min}), unix).size(), 2u);
}

}  // namespace
}  // namespace dynamic_icp::datasets
