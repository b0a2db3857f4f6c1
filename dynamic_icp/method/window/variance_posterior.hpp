// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

namespace dynamic_icp::window {

/// What is known of the variance q of one unknown x ~ N(0, q) that may well be zero: the posterior of log q on a grid.
/// Below `scale` all q are as likely, above it those of standard deviation s by scale / s: an error that is not there
/// costs nothing, and a large one is found. MacKay's fixed point would take what no data know for zero.
class VariancePosterior {
 public:
  struct Prior {
    double scale = 1.0;      ///< standard deviation
    double min_sigma = 0.1;  ///< the grid is between these
    double max_sigma = 10.0;
  };

  explicit VariancePosterior(const Prior& prior);

  /// exp E[log q]
  [[nodiscard]] double value() const { return variance_; }

  /// The estimate of the unknown by all data so far, and its posterior variance, with x ~ N(0, value()) as its prior.
  /// What an earlier call said no longer counts.
  void update(double estimate, double posterior_variance);

 private:
  static constexpr std::size_t kSteps = 32;

  void renew(double measured, double variance);

  std::array<double, kSteps> q_{};      ///< evenly in log q
  std::array<double, kSteps> prior_{};  ///< log density
  double variance_ = 1.0;
};

}  // namespace dynamic_icp::window
