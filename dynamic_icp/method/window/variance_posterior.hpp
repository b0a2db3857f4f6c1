// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace dynamic_icp::window {

/// What is known of the variance q of unknowns x ~ N(0, q), one a scan, that may well be zero: the posterior of log q
/// on a grid. Below `scale` all q are as likely, above it those of standard deviation s by scale / s: a sensor without
/// the error loses nothing, and a few scans show a large one. Old evidence fades.
class VariancePosterior {
 public:
  struct Prior {
    double scale = 1.0;      ///< standard deviation
    double min_sigma = 0.1;  ///< the grid is between these
    double max_sigma = 10.0;
    double counts = 0.0;  ///< as if so many unknowns of standard deviation `scale` had been seen
    bool by_differences =
        false;  ///< what is alike in two scans is no noise, but an error of what they are compared with
  };

  explicit VariancePosterior(const Prior& prior);

  /// exp E[log q]
  [[nodiscard]] double value() const { return variance_; }

  /// From the unknown of a scan, its estimate and posterior variance with x ~ N(0, value()) as its prior. May be called
  /// again with a better estimate before `keep`. By which share the value grew.
  double propose(double estimate, double posterior_variance);

  /// The evidence of the last `propose` becomes part of the past.
  void keep() {
    seen_ = next_seen_;
    last_ = now_;
  }

 private:
  static constexpr std::size_t kSteps = 32;

  struct Measurement {
    double value = 0.0;
    double variance = 0.0;  ///< without q
  };

  void renew();

  std::array<double, kSteps> q_{};          ///< evenly in log q
  std::array<double, kSteps> prior_{};      ///< log density
  std::array<double, kSteps> seen_{};       ///< log likelihood of the past, faded
  std::array<double, kSteps> next_seen_{};  ///< with that of the scan at hand
  bool by_differences_;
  std::optional<Measurement> last_;
  std::optional<Measurement> now_;
  double variance_ = 1.0;
};

}  // namespace dynamic_icp::window
