// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/variance_posterior.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dynamic_icp::window {
namespace {

// A measurement that is so much less certain than the prior tells nothing.
constexpr double kMinKnown = 0.02;

}  // namespace

VariancePosterior::VariancePosterior(const Prior& prior) {
  const double low = std::log(prior.min_sigma);
  const double step = (std::log(prior.max_sigma) - low) / static_cast<double>(kSteps - 1);
  for (std::size_t k = 0; k < kSteps; ++k) {
    q_[k] = std::exp(2.0 * (low + step * static_cast<double>(k)));
    prior_[k] = -0.5 * std::log1p(q_[k] / (prior.scale * prior.scale));
  }
  renew(0.0, std::numeric_limits<double>::max());
}

void VariancePosterior::update(double estimate, double posterior_variance) {
  // With the share that the data know of x, they alone say x = estimate / known with the variance q (1 - known) /
  // known.
  const double known = std::clamp(1.0 - posterior_variance / variance_, kMinKnown, 1.0);
  renew(estimate / known, variance_ * (1.0 - known) / known);
}

void VariancePosterior::renew(double measured, double variance) {
  std::array<double, kSteps> log_density{};
  for (std::size_t k = 0; k < kSteps; ++k) {
    const double expected = q_[k] + variance;
    log_density[k] = prior_[k] - 0.5 * (std::log(expected) + measured * measured / expected);
  }
  const double most = *std::ranges::max_element(log_density);
  double sum = 0.0;
  double log_sum = 0.0;
  for (std::size_t k = 0; k < kSteps; ++k) {
    const double density = std::exp(log_density[k] - most);
    sum += density;
    log_sum += density * std::log(q_[k]);
  }
  variance_ = std::exp(log_sum / sum);
}

}  // namespace dynamic_icp::window
