// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/variance_posterior.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace dynamic_icp::window {
namespace {

constexpr VariancePrior kPrior = {.scale = 0.5, .min_sigma = 0.01, .max_sigma = 100.0};

/// Of an unknown whose measurement says `measured` with `sigma`.
ScalarEstimate estimated(double measured, double sigma, double prior_variance) {
  const double gain = prior_variance / (prior_variance + sigma * sigma);
  return {gain * measured, (1.0 - gain) * prior_variance, prior_variance};
}

/// The deviation that is learned of it, estimated again and again with the variance learned so far.
double learned_after(double measured, double sigma) {
  double q = kPrior.scale * kPrior.scale;
  for (int k = 0; k < 20; ++k) {
    q = posterior_variance(kPrior, estimated(measured, sigma, q));
  }
  return std::sqrt(q);
}

TEST(VariancePosterior, ALargeErrorIsFound) {
  for (const double error : {2.0, 20.0}) {
    EXPECT_GT(learned_after(error, 0.1), 0.4 * error);
    EXPECT_LT(learned_after(error, 0.1), 2.5 * error);
  }
}

TEST(VariancePosterior, AnErrorThatIsNotThereIsFarBelowItsScale) {
  EXPECT_LT(learned_after(0.0, 0.05), 0.1 * kPrior.scale);
  EXPECT_LT(learned_after(0.05, 0.05), 0.2 * kPrior.scale) << "nor is the noise of its measurement taken for it";
}

TEST(VariancePosterior, WithoutEvidenceItStaysOpen) {
  const double q = std::sqrt(posterior_variance(kPrior, {0.0, 1.0, 1.0}));
  EXPECT_GT(q, 0.1 * kPrior.scale);
  EXPECT_LT(q, kPrior.scale);
}

TEST(VariancePosterior, ThePriorOfTheEstimateDoesNotCount) {
  for (const double measured : {0.0, 0.3, 4.0}) {
    const double learned = posterior_variance(kPrior, estimated(measured, 0.2, 1.0));
    for (const double q : {0.01, 0.2, 30.0}) {
      EXPECT_NEAR(posterior_variance(kPrior, estimated(measured, 0.2, q)), learned, 1e-9 * learned);
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::window
