// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/conversion/column_types.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace dynamic_icp::conversion {
namespace {

using formats::NpyType;

NpyType type_of(const std::vector<double>& values, bool prefer_integers) {
  ValueSurvey survey;
  for (const double value : values) {
    survey.add(value);
  }
  return survey.type(prefer_integers);
}

TEST(ValueSurvey, TheSmallestTypeThatHoldsAll) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(type_of({0.5, -1e30F, nan, inf}, false), NpyType::kFloat32);
  EXPECT_EQ(type_of({0.5, 0.1}, false), NpyType::kFloat64);
  EXPECT_EQ(type_of({1e300}, false), NpyType::kFloat64);
  EXPECT_EQ(type_of({0, 255}, true), NpyType::kUint8);
  EXPECT_EQ(type_of({0, 256}, true), NpyType::kInt32);
  EXPECT_EQ(type_of({-1, 255}, true), NpyType::kInt32);
  EXPECT_EQ(type_of({0, 3e9}, true), NpyType::kUint32);
  EXPECT_EQ(type_of({-1, 3e9}, true), NpyType::kInt64);
  EXPECT_EQ(type_of({1, nan}, true), NpyType::kFloat32);
  EXPECT_EQ(type_of({1, -0.0}, true), NpyType::kFloat32);
  EXPECT_EQ(type_of({9007199254740994.0}, true), NpyType::kFloat64) << "beyond 2^53 nobody knows which integer";
  EXPECT_EQ(type_of({}, false), NpyType::kFloat32);
}

RawScan scan_with(const std::vector<double>& times) {
  RawScan scan;
  scan.points.resize(times.size(), Eigen::Vector3d(1, 2, 3));
  scan.doppler.resize(times.size());
  scan.times = times;
  return scan;
}

TEST(ColumnTypes, TimesAsTheyCame) {
  ColumnTypes none;
  none.add(scan_with({}), {});
  EXPECT_EQ(none.time_column(), TimeColumn::kNone);

  ColumnTypes seconds;  // from float32 seconds
  seconds.add(scan_with({0.0, static_cast<double>(0.1F), 0.0625}), {});
  EXPECT_EQ(seconds.time_column(), TimeColumn::kSeconds);
  EXPECT_EQ(seconds.time_type(), NpyType::kFloat32);

  ColumnTypes nanoseconds_;  // from int32 nanoseconds
  nanoseconds_.add(scan_with({0.0, 1e-9 * 98'765'431, 1e-9 * -7}), {});
  EXPECT_EQ(nanoseconds_.time_column(), TimeColumn::kNanoseconds);
  EXPECT_EQ(nanoseconds_.time_type(), NpyType::kInt32);

  ColumnTypes doubles;
  doubles.add(scan_with({0.0, 1.0 / 3.0}), {});
  EXPECT_EQ(doubles.time_column(), TimeColumn::kSeconds);
  EXPECT_EQ(doubles.time_type(), NpyType::kFloat64);
}

TEST(ColumnTypes, EveryWholeNanosecondComesBack) {
  for (std::int64_t ns = -1000; ns < 200'000'000; ns = ns * 2 + 1001) {
    EXPECT_EQ(1e-9 * static_cast<double>(nanoseconds(1e-9 * static_cast<double>(ns))), 1e-9 * static_cast<double>(ns));
    EXPECT_EQ(nanoseconds(1e-9 * static_cast<double>(ns)), ns);
  }
}

TEST(ColumnTypes, ColumnsThatSomeScansLackAreNone) {
  ColumnTypes types;
  RawScan scan = scan_with({0.5});
  types.add(scan, {});
  types.add(RawScan{}, {});  // without points: lacks nothing
  EXPECT_EQ(types.time_column(), TimeColumn::kSeconds);
  EXPECT_FALSE(types.some_times_missing());
  scan.times.clear();
  scan.directions = {{0, 0, 1}};
  types.add(scan, {});
  EXPECT_EQ(types.time_column(), TimeColumn::kNone);
  EXPECT_TRUE(types.some_times_missing());
  EXPECT_TRUE(types.some_lines_of_sight_missing());
  EXPECT_FALSE(types.has_lines_of_sight());
}

}  // namespace
}  // namespace dynamic_icp::conversion
