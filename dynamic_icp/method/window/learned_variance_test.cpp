// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/learned_variance.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace dynamic_icp::window {
namespace {

constexpr double kMeasured = 0.5;  // standard deviation of the measurement of each unknown

/// The mean of what is learned of unknowns of standard deviation `sigma` that are measured one by one.
double learned(double sigma, double start_sigma) {
  LearnedVariance variance({.sigma = start_sigma, .counts = 2.0, .min_sigma = 1e-3, .max_sigma = 1e3});
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  double sum = 0.0;
  constexpr int kScans = 4000;
  constexpr int kSettled = 1000;
  for (int k = 0; k < kScans; ++k) {
    const double measured = sigma * normal(random) + kMeasured * normal(random);
    const double q = variance.value();
    const double gain = q / (q + kMeasured * kMeasured);
    variance.propose(gain * measured, (1.0 - gain) * q);
    variance.keep();
    sum += k >= kSettled ? variance.value() : 0.0;
  }
  return sum / (kScans - kSettled);
}

TEST(LearnedVariance, KnowsWhatAnotherPriorWouldHaveLeft) {
  const auto posterior = [](double prior) {
    const double gain = prior / (prior + kMeasured * kMeasured);
    return KnownValue{gain * 0.7, gain * kMeasured * kMeasured};  // 0.7 was measured
  };
  for (const double after : {1e-4, 0.3, 1e4}) {
    const KnownValue known = with_prior(posterior(0.3), 0.3, after);
    EXPECT_NEAR(known.value, posterior(after).value, 1e-12) << after;
    EXPECT_NEAR(known.variance, posterior(after).variance, 1e-12) << after;
  }
}

TEST(LearnedVariance, FollowsWhatIsMeasured) {
  // The memory of eight scans makes it scatter, and overshooting adds some.
  for (const double start : {0.05, 50.0}) {
    EXPECT_GT(learned(2.0, start), 0.6 * 4.0);
    EXPECT_LT(learned(2.0, start), 1.7 * 4.0);
  }
}

TEST(LearnedVariance, IsSmallWhereNothingVaries) { EXPECT_LT(learned(0.0, 5.0), 0.2 * kMeasured * kMeasured); }

// Unknowns x_k of which only changes are measured, by an instrument that is off by `drift`: a filter takes the drift
// for a growing offset, unless their variance bounds it.
TEST(LearnedVariance, ChangesTellOfUnknownsThatDriftTogether) {
  constexpr double kSigma = 2.0;
  for (const double drift : {0.0, 0.6}) {
    LearnedVariance variance({.sigma = 0.5, .counts = 2.0, .min_sigma = 1e-3, .max_sigma = 1e3});
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    double last = 0.0;      // x_{k-1}
    double estimate = 0.0;  // of it
    double of_estimate = 0.0;
    double sum = 0.0;
    constexpr int kScans = 4000;
    for (int k = 0; k < kScans; ++k) {
      const double now = kSigma * normal(random);
      const double measured = now - last + drift + kMeasured * normal(random);
      const double q = variance.value();
      const double prior = q + of_estimate;
      const double gain = prior / (prior + kMeasured * kMeasured);
      const double innovation = measured + estimate;
      variance.propose_change(-estimate + gain * innovation, (1.0 - gain) * prior, -estimate, prior);
      variance.keep();
      estimate = q / (prior + kMeasured * kMeasured) * innovation;
      of_estimate = q * (of_estimate + kMeasured * kMeasured) / (prior + kMeasured * kMeasured);
      last = now;
      sum += k >= kScans / 4 ? variance.value() : 0.0;
    }
    const double mean = sum / (0.75 * kScans);
    EXPECT_GT(mean, 0.6 * kSigma * kSigma) << drift;
    EXPECT_LT(mean, 1.7 * kSigma * kSigma) << drift;
  }
}

/// In a tunnel planes claim to know a hundredth of a stamp along the motion, and are off by more than they claim.
TEST(LearnedVariance, LearnsNothingOfAChangeThatIsNotSeen) {
  LearnedVariance variance({.sigma = 1.0, .counts = 2.0, .min_sigma = 0.1, .max_sigma = 30.0});
  for (int k = 0; k < 100; ++k) {
    const double prior = 2.0 * variance.value();
    EXPECT_EQ(variance.propose_change(0.3 * std::sqrt(prior), 0.99 * prior, 0.0, prior), 0.0);
    variance.keep();
  }
  EXPECT_DOUBLE_EQ(variance.value(), 1.0);
}

TEST(LearnedVariance, ABetterEstimateReplacesTheOneBefore) {
  LearnedVariance once({.sigma = 1.0, .counts = 2.0, .min_sigma = 0.0, .max_sigma = 10.0});
  LearnedVariance again = once;
  once.propose(0.9, 0.0);
  once.keep();
  EXPECT_GT(again.propose(3.0, 0.0), 0.0);
  again.propose(0.9, 0.0);
  again.keep();
  // The evidence is the same; the value may differ by how it was approached.
  once.update(0.0, 0.0);
  once.keep();
  again.update(0.0, 0.0);
  again.keep();
  EXPECT_NEAR(once.value(), again.value(), 1e-12);
}

TEST(LearnedVariance, MacKaysFixedPointStaysWhereItIs) {
  LearnedVariance variance({.sigma = 2.0, .counts = 1.0, .min_sigma = 0.0, .max_sigma = 10.0});
  for (int k = 0; k < 50; ++k) {
    variance.update(4.0 * 3.0, 3.0);
    variance.keep();  // three known unknowns with squares of 4 each
  }
  EXPECT_NEAR(variance.value(), 4.0, 1e-9);
}

TEST(LearnedVariance, StaysWithinItsBounds) {
  LearnedVariance variance({.sigma = 1.0, .counts = 1.0, .min_sigma = 0.5, .max_sigma = 2.0});
  for (int k = 0; k < 20; ++k) {
    variance.update(1e6, 1.0);
    variance.keep();
  }
  EXPECT_DOUBLE_EQ(variance.value(), 4.0);
  for (int k = 0; k < 200; ++k) {
    variance.update(0.0, 1.0);
    variance.keep();
  }
  EXPECT_DOUBLE_EQ(variance.value(), 0.25);
}

}  // namespace
}  // namespace dynamic_icp::window
