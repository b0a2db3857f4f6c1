// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/variance_posterior.hpp"

#include <algorithm>
#include <cmath>

namespace dynamic_icp::window {
namespace {

// What is left of the evidence after one more scan.
constexpr double kMemory = 0.87;

// A measurement that is so much less certain than the prior tells nothing.
constexpr double kMinKnown = 0.02;

}  // namespace

VariancePosterior::VariancePosterior(const Prior& prior) : by_differences_(prior.by_differences) {
  const double low = std::log(prior.min_sigma);
  const double step = (std::log(prior.max_sigma) - low) / static_cast<double>(kSteps - 1);
  const double scale_variance = prior.scale * prior.scale;
  for (std::size_t k = 0; k < kSteps; ++k) {
    q_[k] = std::exp(2.0 * (low + step * static_cast<double>(k)));
    const double ratio = q_[k] / scale_variance;
    prior_[k] = -0.5 * std::log1p(ratio) - 0.5 * prior.counts * (std::log(ratio) + 1.0 / ratio);
  }
  renew();
}

double VariancePosterior::propose(double estimate, double posterior_variance) {
  // With the share that the data know of x, they alone say x = estimate / known with the variance q (1 - known) /
  // known.
  const double known = std::clamp(1.0 - posterior_variance / variance_, kMinKnown, 1.0);
  now_ = {estimate / known, variance_ * (1.0 - known) / known};
  Measurement seen = *now_;
  double unknowns = by_differences_ && !last_ ? 0.0 : 1.0;
  if (by_differences_ && last_) {
    seen = {now_->value - last_->value, now_->variance + last_->variance};
    unknowns = 2.0;
  }
  for (std::size_t k = 0; k < kSteps; ++k) {
    const double expected = unknowns * q_[k] + seen.variance;
    next_seen_[k] = kMemory * seen_[k] - 0.5 * (std::log(expected) + seen.value * seen.value / expected);
  }
  const double before = variance_;
  renew();
  return variance_ / before - 1.0;
}

void VariancePosterior::renew() {
  std::array<double, kSteps> log_density{};
  for (std::size_t k = 0; k < kSteps; ++k) {
    log_density[k] = prior_[k] + next_seen_[k];
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
