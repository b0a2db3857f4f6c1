// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/sweep_search.hpp"

#include <algorithm>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "testing/spoiled_recording.hpp"

namespace dynamic_icp::diagnosis {
namespace {

using motion::SweepDuration;

constexpr SweepDuration kUnobservable;

SweepSearch judged(const SweepDuration& by_azimuth, const SweepDuration& as_stored) {
  return judge_sweep(by_azimuth, as_stored, kPeriod_s);
}

TEST(SweepJudging, DecidesOnlyBeyondDoubt) {
  const SweepDuration zero{0.001, 0.003, 0.1};
  EXPECT_EQ(judged({0.098, 0.005, 400.0}, zero).hypothesis, SweepHypothesis::kAzimuthCcw);
  EXPECT_EQ(judged({-0.098, 0.005, 400.0}, zero).hypothesis, SweepHypothesis::kAzimuthCw);
  EXPECT_EQ(judged(zero, {0.098, 0.005, 400.0}).hypothesis, SweepHypothesis::kAsStored);
  EXPECT_EQ(judged(zero, {-0.098, 0.005, 400.0}).hypothesis, SweepHypothesis::kUnknown) << "nothing stores backwards";
  EXPECT_EQ(judged(zero, zero).hypothesis, SweepHypothesis::kInstant);
  EXPECT_EQ(judged({0.098, 0.02, 25.0}, zero).hypothesis, SweepHypothesis::kUnknown) << "2.9 standard errors";
  EXPECT_EQ(judged({0.0, 0.02, 0.0}, zero).hypothesis, SweepHypothesis::kUnknown) << "2 standard errors";
  EXPECT_EQ(judged(kUnobservable, kUnobservable).hypothesis, SweepHypothesis::kUnknown);
  EXPECT_NEAR(judged({0.1, 0.01, 100.0}, zero).margin, 6.0, 1e-12) << "to 0.4 of the period";
}

TEST(SweepJudging, BelievesNothingWhereAMeasurementIsAbsurd) {
  EXPECT_EQ(judged({-0.8, 0.08, 9e3}, {0.1, 0.005, 400.0}).hypothesis, SweepHypothesis::kUnknown);
}

TEST(SweepJudging, PrefersTheAzimuthUnlessTheFileExplainsClearlyMore) {
  const SweepDuration azimuth{0.1, 0.005, 400.0};
  EXPECT_EQ(judged(azimuth, {0.1, 0.005, 440.0}).hypothesis, SweepHypothesis::kAzimuthCcw);
  EXPECT_EQ(judged(azimuth, {0.1, 0.005, 800.0}).hypothesis, SweepHypothesis::kAsStored);
}

TEST(SweepJudging, TakesThePeriodWhereTheMeasurementAllowsIt) {
  EXPECT_EQ(judged({0.09, 0.004, 400.0}, kUnobservable).duration_s, kPeriod_s);
  EXPECT_EQ(judged({0.11, 0.001, 400.0}, kUnobservable).duration_s, kPeriod_s) << "never longer";
  EXPECT_EQ(judged({-0.07, 0.002, 400.0}, kUnobservable).duration_s, 0.07);
}

TEST(SweepJudging, DeclaresWhatWasFound) {
  motion::SweepConfig config;
  declare(judged({-0.1, 0.005, 400.0}, kUnobservable), config);
  EXPECT_EQ(config.declared_duration_s, kPeriod_s);
  EXPECT_TRUE(config.declared_left_to_right);
  EXPECT_FALSE(config.declared_as_stored);
  declare(judged(kUnobservable, {0.1, 0.005, 400.0}), config);
  EXPECT_TRUE(config.declared_as_stored);
}

/// A drive whose points have no times.
Recording swept() {
  Recording recording;
  recording.sensor.sweep_s = kPeriod_s;
  recording.sensor.gives_times = false;
  return recording;
}

std::optional<SweepSearch> search(Recording& recording, int threads = 1) {
  return search_sweep(recording.ready(), {0, recording.size()}, kPeriod_s, Workers(threads));
}

SweepHypothesis hypothesis(Recording recording) { return search(recording).value().hypothesis; }

void shuffle(RawScan& raw, const Vector3d&) {
  std::vector<std::size_t> order(raw.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937(7));
  const RawScan as_it_was = raw;
  for (std::size_t i = 0; i < order.size(); ++i) {
    raw.points[i] = as_it_was.points[order[i]];
    raw.doppler[i] = as_it_was.doppler[order[i]];
  }
}

/// What a sensor that sweeps the other way sees in a mirrored world.
void mirror(RawScan& raw, const Vector3d&) {
  for (Vector3d& point : raw.points) {
    point.y() = -point.y();
  }
}

TEST(SweepSearch, FindsHowScansWereTaken) {
  EXPECT_EQ(hypothesis(swept()), SweepHypothesis::kAzimuthCcw);
  EXPECT_EQ(hypothesis({}), SweepHypothesis::kInstant);
  Recording mirrored = swept();
  mirrored.perturb = mirror;
  EXPECT_EQ(hypothesis(mirrored), SweepHypothesis::kAzimuthCw);
  Recording shuffled = swept();
  shuffled.perturb = shuffle;
  EXPECT_EQ(hypothesis(shuffled), SweepHypothesis::kAzimuthCcw);
}

TEST(SweepSearch, CannotTellOfASensorThatStandsStill) {
  Recording recording = swept();
  recording.path = synthetic::circle(0.0, 0.0);
  EXPECT_EQ(hypothesis(recording), SweepHypothesis::kUnknown);
}

TEST(SweepSearch, AsksNothingWhereItIsNotAsked) {
  Recording timed = swept();
  timed.sensor.gives_times = true;
  EXPECT_FALSE(search(timed).has_value());
  Recording compensated = swept();
  compensated.perturb = [](RawScan& raw, const Vector3d&) { raw.doppler_kind = DopplerKind::kCompensated; };
  EXPECT_FALSE(search(compensated).has_value());
  Recording few = swept();
  EXPECT_FALSE(search_sweep(few.ready(), {0, 9}, kPeriod_s, Workers(1)).has_value());
}

TEST(SweepSearch, IsTheSameForAnyNumberOfThreads) {
  Recording recording = swept();
  const SweepSearch one = search(recording, 1).value();
  const SweepSearch three = search(recording, 3).value();
  EXPECT_EQ(one.by_azimuth.duration_s, three.by_azimuth.duration_s);
  EXPECT_EQ(one.as_stored.sigma_s, three.as_stored.sigma_s);
  EXPECT_EQ(one.sentence, three.sentence);
}

}  // namespace
}  // namespace dynamic_icp::diagnosis
