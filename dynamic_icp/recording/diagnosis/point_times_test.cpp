// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "dynamic_icp/recording/diagnosis/questions.hpp"

namespace dynamic_icp::diagnosis {
namespace {

/// Two scans, 0.1 s apart, whose points have such times.
Evidence with_times(double first_s, double last_s) {
  Evidence evidence;
  evidence.period_s = 0.1;
  evidence.looks.resize(2);
  evidence.looks[1].has_times = true;
  evidence.looks[1].first_time_s = first_s;
  evidence.looks[1].last_time_s = last_s;
  return evidence;
}

TEST(PointTimes, WithinAScanAreRight) {
  EXPECT_EQ(point_times(with_times(0.0, 0.099)).verdict, Verdict::kOk);
  EXPECT_EQ(point_times(with_times(-0.0005, 0.12)).verdict, Verdict::kOk);
}

TEST(PointTimes, NoneOrZerosCannotTell) {
  EXPECT_EQ(point_times({}).verdict, Verdict::kCannotTell);
  EXPECT_EQ(point_times(with_times(0.0, 0.0)).verdict, Verdict::kCannotTell);
}

TEST(PointTimes, WhatTheDopplerSaysOfPointsWithoutTimes) {
  const motion::SweepDuration zero{0.0, 0.003, 0.0};
  const auto answer = [&](const motion::SweepDuration& by_azimuth) {
    Evidence evidence;
    evidence.looks.resize(2);
    evidence.sweep = judge_sweep(by_azimuth, zero, 0.1);
    return point_times(evidence);
  };
  EXPECT_EQ(answer(zero).verdict, Verdict::kOk);
  EXPECT_EQ(answer({}).verdict, Verdict::kCannotTell);
  const Finding swept = answer({-0.1, 0.005, 400.0});
  EXPECT_EQ(swept.verdict, Verdict::kSuspicious) << "the times are missing";
  EXPECT_NE(swept.sentence.find("clockwise (left to right) in 0.100 s"), std::string::npos) << swept.sentence;
}

TEST(PointTimes, NoScanTakesSeconds) {
  EXPECT_EQ(point_times(with_times(0.0, 99.0)).verdict, Verdict::kWrong) << "milliseconds";
  EXPECT_EQ(point_times(with_times(-0.6, -0.5)).verdict, Verdict::kWrong);
}

TEST(PointTimes, BeforeTheStampOrLongerThanThePeriodAreSuspicious) {
  EXPECT_EQ(point_times(with_times(-0.05, 0.05)).verdict, Verdict::kSuspicious);
  EXPECT_EQ(point_times(with_times(0.0, 0.2)).verdict, Verdict::kSuspicious);
  Evidence one_scan = with_times(0.0, 0.2);
  one_scan.period_s = 0.0;
  EXPECT_EQ(point_times(one_scan).verdict, Verdict::kOk) << "of one scan nobody knows the period";
}

}  // namespace
}  // namespace dynamic_icp::diagnosis
