// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/variance_posterior.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace dynamic_icp::window {
namespace {

constexpr std::size_t kSteps = 32;  // evenly in log q

// A measurement that is so much less certain than the prior tells nothing.
constexpr double kMinShareKnown = 0.02;

}  // namespace

double posterior_variance(const VariancePrior& prior, const ScalarEstimate& estimate) {
  // With the share that the data know of x, they alone say x = value / known with the variance of noise below.
  const double known = std::clamp(1.0 - estimate.variance / estimate.prior_variance, kMinShareKnown, 1.0);
  const double measured = estimate.value / known;
  const double noise = estimate.prior_variance * (1.0 - known) / known;

  const double low = std::log(prior.min_sigma);
  const double step = (std::log(prior.max_sigma) - low) / static_cast<double>(kSteps - 1);
  std::array<double, kSteps> log_q{};
  std::array<double, kSteps> log_density{};
  for (std::size_t k = 0; k < kSteps; ++k) {
    log_q[k] = 2.0 * (low + step * static_cast<double>(k));
    const double q = std::exp(log_q[k]);
    const double expected = q + noise;
    log_density[k] =
        -0.5 * (std::log1p(q / (prior.scale * prior.scale)) + std::log(expected) + measured * measured / expected);
  }
  const double most = *std::ranges::max_element(log_density);
  double sum = 0.0;
  double log_sum = 0.0;
  for (std::size_t k = 0; k < kSteps; ++k) {
    const double density = std::exp(log_density[k] - most);
    sum += density;
    log_sum += density * log_q[k];
  }
  return std::exp(log_sum / sum);
}

}  // namespace dynamic_icp::window
