// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/record_guess.hpp"

#include <limits>

#include "testing/recording_by_hand.hpp"

namespace dynamic_icp::datasets {
namespace {

using formats::kAeva29;
using formats::kXyzd;

std::string repeated(const std::string& record, int count) {
  std::string bytes;
  for (int i = 0; i < count; ++i) {
    bytes += record;
  }
  return bytes;
}

TEST(RecordGuess, NearlyAllSamplesMustBePossible) {
  const std::string good = aeva_record(1, 2, 3, -4, 5);
  const std::string bad = aeva_record(2000, 2, 3, -4, 5);
  EXPECT_TRUE(looks_like(good, kAeva29));
  EXPECT_TRUE(looks_like(repeated(good, 199) + bad, kAeva29));
  EXPECT_FALSE(looks_like(repeated(good, 195) + repeated(bad, 5), kAeva29));
  EXPECT_FALSE(looks_like("", kAeva29));
  EXPECT_FALSE(looks_like(good + "x", kAeva29)) << "size";
}

TEST(RecordGuess, EveryDemandCounts) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const std::string& bad :
       {aeva_record(nan, 2, 3, -4, 5), aeva_record(1e-9F, 2, 3, -4, 5), aeva_record(1, 2, 3, 130, 5),
        aeva_record(1, 2, 3, nan, 5), aeva_record(1, 2, 3, -4, 200'000'001), aeva_record(1, 2, 3, -4, -1'000'001),
        aeva_record(1, 2, 3, -4, 5, 128), aeva_record(1, 2, 3, -4, 5).substr(0, 25) + floats({101}),
        aeva_record(1, 2, 3, -4, 5).substr(0, 25) + floats({nan})}) {
    EXPECT_FALSE(looks_like(bad, kAeva29));
  }
  EXPECT_TRUE(looks_like(aeva_record(0, 0, 0, 0, 0), kAeva29)) << "zeros are possible";
}

TEST(RecordGuess, DopplerHasBothSignsOrIsAboveOne) {
  EXPECT_FALSE(looks_like(floats({1, 2, 3, 0.5F}), kXyzd));
  EXPECT_FALSE(looks_like(floats({1, 2, 3, 0}), kXyzd));
  EXPECT_TRUE(looks_like(floats({1, 2, 3, -2}), kXyzd));
  EXPECT_TRUE(looks_like(floats({1, 2, 3, 0.5F, 1, 2, 3, -0.5F}), kXyzd));
}

TEST(RecordGuess, TimesOfAScanPassInTheirOrder) {
  const auto scan = [](float first, float step) {
    std::string bytes;
    for (int i = 0; i < 100; ++i) {
      bytes += floats({1, 2, 3, -4, first + step * static_cast<float>(i)});
    }
    return bytes;
  };
  EXPECT_TRUE(looks_like(scan(0.0F, 0.001F), formats::kXyzdTime));
  EXPECT_FALSE(looks_like(scan(0.1F, -0.001F), formats::kXyzdTime)) << "backwards";
  EXPECT_FALSE(looks_like(scan(0.0F, 0.01F), formats::kXyzdTime)) << "too long";
  EXPECT_FALSE(looks_like(scan(0.0F, 0.0F), formats::kXyzdTime)) << "none";
}

}  // namespace
}  // namespace dynamic_icp::datasets
