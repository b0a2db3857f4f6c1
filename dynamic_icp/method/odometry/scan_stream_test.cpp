// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/scan_stream.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::odometry {
namespace {

constexpr std::size_t kEnough = 6;

Stamp at_ms(std::int64_t ms) { return {ms * 1'000'000}; }

TEST(ScanStream, SaysWhatCannotBeAlignedAndKeepsTheLastUsableScan) {
  ScanStream stream({.max_gap_s = 1.0, .min_points = 6});
  EXPECT_EQ(stream.add(at_ms(1000), 5), FrameStatus::kTooFewPoints);
  EXPECT_EQ(stream.add(at_ms(2000), kEnough), FrameStatus::kFirst);
  EXPECT_EQ(stream.add(at_ms(2100), kEnough), FrameStatus::kNotRun);
  EXPECT_DOUBLE_EQ(stream.interval_s(), 0.1);
  EXPECT_EQ(stream.add(at_ms(2200), 5), FrameStatus::kTooFewPoints);
  EXPECT_EQ(stream.add(at_ms(2300), kEnough), FrameStatus::kNotRun);
  EXPECT_DOUBLE_EQ(stream.interval_s(), 0.2) << "after the last usable scan";
  EXPECT_DOUBLE_EQ(stream.since_any_s(), 0.1);
  EXPECT_DOUBLE_EQ(stream.elapsed_s(), 0.3) << "after the first usable scan";
}

TEST(ScanStream, TooSoonIsSkippedAndAGapIsNot) {
  ScanStream stream({.max_gap_s = 1.0, .min_points = 6});
  stream.add({0}, kEnough);
  EXPECT_EQ(stream.add({999'999}, kEnough), FrameStatus::kTooSoon);
  EXPECT_EQ(stream.add({1'000'000}, kEnough), FrameStatus::kNotRun) << "1 ms after the usable one";
  EXPECT_EQ(stream.add(at_ms(1001), kEnough), FrameStatus::kNotRun) << "1 s is no gap yet";
  EXPECT_EQ(stream.add(at_ms(2002), kEnough), FrameStatus::kTimeGap);
  EXPECT_EQ(stream.add(at_ms(2102), kEnough), FrameStatus::kNotRun) << "the scan after a gap is the next reference";
  EXPECT_DOUBLE_EQ(stream.interval_s(), 0.1);
}

TEST(ScanStream, AMotionIsPredictedForAMinuteAtMost) {
  ScanStream stream({.max_gap_s = 1.0, .min_points = 6});
  stream.add(at_ms(0), kEnough);
  stream.add(at_ms(500), kEnough);
  EXPECT_DOUBLE_EQ(stream.prediction_time_s(), 0.5);
  stream.add(at_ms(3'600'000), kEnough);
  EXPECT_DOUBLE_EQ(stream.prediction_time_s(), kMaxPrediction_s);
}

TEST(ScanStream, RefusesTimeThatStandsStillOrRunsBackwards) {
  ScanStream stream({.max_gap_s = 1.0, .min_points = 6});
  EXPECT_NO_THROW(stream.check_order(at_ms(5)));
  stream.add(at_ms(5), 0);
  EXPECT_THROW(stream.check_order(at_ms(5)), DataError) << "also after an unusable scan";
  EXPECT_THROW(stream.check_order(at_ms(4)), DataError);
  EXPECT_NO_THROW(stream.check_order({5'000'001}));
}

}  // namespace
}  // namespace dynamic_icp::odometry
