// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/variance_posterior.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace dynamic_icp::window {
namespace {

constexpr VariancePosterior::Prior kPrior = {.scale = 0.5, .min_sigma = 0.01, .max_sigma = 100.0};

/// The deviation that is learned of an unknown whose measurement says `measured` with `sigma`, estimated again and
/// again with the variance learned so far.
double learned(double measured, double sigma) {
  VariancePosterior posterior(kPrior);
  for (int k = 0; k < 20; ++k) {
    const double q = posterior.value();
    const double gain = q / (q + sigma * sigma);
    posterior.update(gain * measured, (1.0 - gain) * q);
  }
  return std::sqrt(posterior.value());
}

TEST(VariancePosterior, ALargeErrorIsFound) {
  for (const double error : {2.0, 20.0}) {
    EXPECT_GT(learned(error, 0.1), 0.4 * error);
    EXPECT_LT(learned(error, 0.1), 2.5 * error);
  }
}

TEST(VariancePosterior, AnErrorThatIsNotThereIsFarBelowItsScale) {
  EXPECT_LT(learned(0.0, 0.05), 0.1 * kPrior.scale);
  EXPECT_LT(learned(0.05, 0.05), 0.2 * kPrior.scale) << "nor is the noise of its measurement taken for it";
}

TEST(VariancePosterior, WithoutEvidenceItStaysOpen) {
  const double before = std::sqrt(VariancePosterior(kPrior).value());
  EXPECT_LT(before, kPrior.scale);
  EXPECT_NEAR(learned(0.0, 50.0), before, 0.5 * before);
}

TEST(VariancePosterior, WhatWasSaidEarlierDoesNotCount) {
  VariancePosterior once(kPrior);
  VariancePosterior again(kPrior);
  const double q = once.value();
  once.update(0.1, 0.5 * q);
  again.update(30.0, 0.5 * q);
  // With the larger variance the same measurement, 0.2 +- sqrt(q), gives another estimate.
  const double larger = again.value();
  const double gain = larger / (larger + q);
  again.update(gain * 0.2, (1.0 - gain) * larger);
  EXPECT_NEAR(again.value(), once.value(), 1e-9 * once.value());
}

}  // namespace
}  // namespace dynamic_icp::window
