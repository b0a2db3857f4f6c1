// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/variance_posterior.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace dynamic_icp::window {
namespace {

constexpr double kMeasured = 0.5;  // standard deviation of the measurement of each unknown
constexpr VariancePosterior::Prior kPrior = {.scale = 0.5, .min_sigma = 0.01, .max_sigma = 100.0};

/// Sees unknowns of standard deviation `sigma`, measured one by one and estimated with the variance learned so far.
double learned(double sigma, int scans, VariancePosterior posterior = VariancePosterior(kPrior), unsigned seed = 7) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (int k = 0; k < scans; ++k) {
    const double measured = sigma * normal(random) + kMeasured * normal(random);
    const double q = posterior.value();
    const double gain = q / (q + kMeasured * kMeasured);
    posterior.propose(gain * measured, (1.0 - gain) * q);
    posterior.keep();
  }
  return posterior.value();
}

TEST(VariancePosterior, FollowsWhatIsMeasured) {
  double log_sum = 0.0;
  constexpr int kRuns = 200;
  for (unsigned run = 0; run < kRuns; ++run) {
    log_sum += std::log(learned(4.0, 60, VariancePosterior(kPrior), run));
  }
  // The memory is eight scans; the mean of the logarithm is less than the logarithm of the mean.
  EXPECT_NEAR(std::sqrt(std::exp(log_sum / kRuns)), 4.0, 0.6);
}

TEST(VariancePosterior, IsFarBelowTheNoiseWhereNothingVaries) {
  EXPECT_LT(std::sqrt(learned(0.0, 60)), 0.3 * kMeasured);
}

TEST(VariancePosterior, AFewScansShowALargeOne) { EXPECT_GT(std::sqrt(learned(20.0, 3)), 5.0); }

TEST(VariancePosterior, WithoutEvidenceItStaysBelowItsScale) {
  VariancePosterior posterior(kPrior);
  EXPECT_LT(std::sqrt(posterior.value()), kPrior.scale);
  EXPECT_GT(std::sqrt(posterior.value()), kPrior.min_sigma);
  // Measurements that are far less certain than the prior do not make it large, whatever they say.
  for (int k = 0; k < 50; ++k) {
    const double q = posterior.value();
    posterior.propose(1e-3 * std::sqrt(q), q * (1.0 - 1e-6));
    posterior.keep();
  }
  EXPECT_LT(std::sqrt(posterior.value()), kPrior.scale);
}

TEST(VariancePosterior, WhatIsKnownOfAnotherDriveCounts) {
  VariancePosterior::Prior known = kPrior;
  known.scale = 5.0;
  known.counts = 10.0;
  EXPECT_NEAR(std::sqrt(VariancePosterior(known).value()), 5.0, 1.0);
}

TEST(VariancePosterior, ByDifferencesWhatIsAlikeIsNoNoise) {
  VariancePosterior::Prior prior = kPrior;
  prior.by_differences = true;
  double log_sum = 0.0;
  constexpr int kRuns = 200;
  for (unsigned run = 0; run < kRuns; ++run) {
    log_sum += std::log(learned(4.0, 60, VariancePosterior(prior), run));
  }
  EXPECT_NEAR(std::sqrt(std::exp(log_sum / kRuns)), 4.0, 0.8) << "noise is learned as before";
  VariancePosterior drift(prior);
  VariancePosterior taken_for_noise(kPrior);
  for (VariancePosterior* posterior : {&drift, &taken_for_noise}) {
    for (int k = 0; k < 30; ++k) {
      const double q = posterior->value();
      const double gain = q / (q + kMeasured * kMeasured);
      posterior->propose(gain * 0.2 * k, (1.0 - gain) * q);
      posterior->keep();
    }
  }
  EXPECT_LT(std::sqrt(drift.value()), kMeasured);
  EXPECT_GT(std::sqrt(taken_for_noise.value()), 2.0);
}

TEST(VariancePosterior, ABetterEstimateReplacesTheOneBefore) {
  VariancePosterior once(kPrior);
  VariancePosterior again(kPrior);
  const double q = once.value();
  once.propose(0.1, 0.5 * q);
  once.keep();
  EXPECT_GT(again.propose(30.0, 0.5 * q), 1.0) << "by which share it grew";
  // With the larger variance the same measurement, 0.2 +- sqrt(q), gives another estimate.
  const double larger = again.value();
  const double gain = larger / (larger + q);
  again.propose(gain * 0.2, (1.0 - gain) * larger);
  again.keep();
  EXPECT_NEAR(again.value(), once.value(), 1e-9 * once.value());
}

}  // namespace
}  // namespace dynamic_icp::window
