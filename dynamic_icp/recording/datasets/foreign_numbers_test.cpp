// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/foreign_numbers.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::datasets {
namespace {

using formats::kXyzd;

TEST(ForeignNumbers, AreThoseOfMostFinitePoints) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  RawScan scan;
  scan.points = {{1, 2, 3}, {1e9, 0, 0}, {nan, 0, 0}};
  scan.doppler = {1, 2, 3};
  EXPECT_NO_THROW(refuse_foreign_numbers(scan, "a.bin", kXyzd)) << "one of two";
  scan.points[0].z() = 1e-30;
  try {
    refuse_foreign_numbers(scan, "a.bin", kXyzd);
    FAIL();
  } catch (const DataError& error) {
    EXPECT_STREQ(error.what(),
                 "a.bin: record 0 at byte 0 has x, y, z = 1, 2, 1e-30 m and Doppler 1 m/s, as have most: expected "
                 "little-endian records of 16 bytes (xyzd)");
  }
  scan.points = {{250'000, -3'000, 12}, {0, 0, 0}};
  scan.doppler = {16'000, 0};
  EXPECT_NO_THROW(refuse_foreign_numbers(scan, "a.bin", kXyzd)) << "millimetres, for the diagnosis";
  EXPECT_NO_THROW(refuse_foreign_numbers({}, "a.bin", kXyzd));
}

TEST(ForeignNumbers, OfColumnsAreSaidByPoint) {
  RawScan scan;
  scan.points = {{1, 2, 3}, {1e9, 0, 0}, {0, 1e20, 0}};
  scan.doppler = {1, 2, 3};
  try {
    refuse_foreign_numbers(scan, "a.ply");
    FAIL();
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find("a.ply: point 1 has x, y, z = 1e+09, 0, 0 m"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace dynamic_icp::datasets
