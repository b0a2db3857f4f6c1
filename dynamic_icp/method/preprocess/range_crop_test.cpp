// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/preprocess/range_crop.hpp"

#include <gtest/gtest.h>

namespace dynamic_icp::preprocess {
namespace {

TEST(RangeCrop, KeepsTheBordersAndTheOrder) {
  RawScan raw;
  raw.points = {{0.1, 0, 0}, {0.0, 0.5, 0}, {300, 400, 0}, {3, 4, 0}, {501, 0, 0}};
  raw.doppler = {0, 1, 2, 3, 4};
  const Scan cropped = crop_range(Scan::from_raw(raw), {.min_range_m = 0.5, .max_range_m = 500.0});
  EXPECT_EQ(cropped.doppler(), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(cropped.records(), (std::vector<std::uint32_t>{1, 2, 3}));
}

TEST(RangeCrop, OfNothingIsNothing) { EXPECT_TRUE(crop_range(Scan{}, {}).empty()); }

TEST(RangeCrop, MeasuresTheDistanceOfThePointNotTheSizeOfAnAxis) {
  RawScan raw;
  raw.points = {{0.15, 0.15, 0.15}, {0.1, 0.1, 0.1}};
  raw.doppler = {0, 0};
  EXPECT_EQ(crop_range(Scan::from_raw(raw), {}).records(), std::vector<std::uint32_t>{0});
}

}  // namespace
}  // namespace dynamic_icp::preprocess
