// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/learned_variance.hpp"

#include <algorithm>

#include "dynamic_icp/method/base/state_archive.hpp"

namespace dynamic_icp::window {
namespace {

// One scan changes a variance by no more than this.
constexpr double kMaxChange = 8.0;

// Of a change that the data know less of than this share nothing is learned: what they say is their own errors, and a
// variance that grows by them lets them say more.
constexpr double kLeastKnown = 0.02;

}  // namespace

KnownValue with_prior(const KnownValue& known, double before, double after) {
  const double variance = 1.0 / (1.0 / known.variance - 1.0 / before + 1.0 / after);
  return {known.value * variance / known.variance, variance};
}

LearnedVariance::LearnedVariance(const Prior& prior)
    : memory_(prior.memory),
      variance_(prior.sigma * prior.sigma),
      min_variance_(prior.min_sigma * prior.min_sigma),
      max_variance_(prior.max_sigma * prior.max_sigma),
      squares_(prior.counts * variance_),
      counts_(prior.counts),
      next_squares_(squares_),
      next_counts_(counts_) {}

double LearnedVariance::propose(double estimate, double posterior_variance) {
  // With the share k that the data know of x, the measurement alone was x / k with the variance q (1 - k) / k.
  const double known = std::clamp(1.0 - posterior_variance / variance_, 0.0, 1.0);
  next_squares_ = memory_ * squares_ + estimate * estimate - variance_ * known * (1.0 - known);
  next_counts_ = memory_ * counts_ + known * known;
  return renew(next_squares_, next_counts_);
}

double LearnedVariance::propose_change(double change, double posterior_variance, double expected,
                                       double prior_variance) {
  // With the share k that the data know of the change, it is k times what they measured, and the rest was expected.
  const double known = std::clamp(1.0 - posterior_variance / prior_variance, 0.0, 1.0);
  if (known < kLeastKnown) {
    next_squares_ = squares_;
    next_counts_ = counts_;
    return 0.0;
  }
  const double measured = change - (1.0 - known) * expected;
  next_squares_ = memory_ * squares_ + 0.5 * (measured * measured - prior_variance * known * (1.0 - known));
  next_counts_ = memory_ * counts_ + known * known;
  return renew(next_squares_, next_counts_);
}

void LearnedVariance::keep() {
  squares_ = next_squares_;
  counts_ = next_counts_;
}

void LearnedVariance::update(double squares, double known) {
  next_squares_ = memory_ * squares_ + squares;
  next_counts_ = memory_ * counts_ + known;
  renew(next_squares_, next_counts_);
}

void LearnedVariance::follow(double variance, double counts) {
  followed_squares_ = counts * variance;
  followed_counts_ = counts;
}

double LearnedVariance::renew(double squares, double counts) {
  const double before = variance_;
  const double ratio =
      std::clamp((squares + followed_squares_) / (counts + followed_counts_) / variance_, 1.0 / kMaxChange, kMaxChange);
  variance_ = std::clamp(variance_ * ratio, min_variance_, max_variance_);
  return variance_ / before - 1.0;
}

void LearnedVariance::state(StateArchive& archive) {
  archive(memory_, variance_, min_variance_, max_variance_, squares_, counts_, followed_squares_, followed_counts_,
          next_squares_, next_counts_);
  archive.require(
      memory_ >= 0.0 && memory_ <= 1.0 && min_variance_ >= 0.0 && min_variance_ <= max_variance_ && variance_ > 0.0,
      "a learned variance");
}

}  // namespace dynamic_icp::window
