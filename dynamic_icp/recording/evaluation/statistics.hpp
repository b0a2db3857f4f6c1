// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace dynamic_icp::evaluation {

/// What a set of errors amounts to; unit as that of the errors.
struct Statistics {
  std::size_t count = 0;
  double rmse = 0.0;  ///< square root of the mean of the squares
  double mean = 0.0;
  double median = 0.0;  ///< `percentile` 50
  double p95 = 0.0;     ///< `percentile` 95
  double max = 0.0;
};

/// Summary of non-negative errors, in any order. Empty when there are none, or when a sum is not finite: no statistic
/// is ever NaN or infinite.
std::optional<Statistics> summarize(std::span<const double> errors);

/// The mean alone.
std::optional<double> mean_of(std::span<const double> errors);

/// The percentile p in [0, 100] of ascending values (at least one), by linear interpolation between the two values
/// around the position p / 100 * (n - 1), counted from 0. NumPy's default is the same.
double percentile(std::span<const double> ascending, double p);

}  // namespace dynamic_icp::evaluation
