// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

// The arithmetic of timing.
namespace dynamic_icp::speed {

/// The middle value, of an even number the mean of the two in the middle; there must be one.
double median(std::vector<double> values);

/// What a set of times amounts to, in the unit of the times.
struct Percentiles {
  double p50 = 0.0;
  double p95 = 0.0;
  double p99 = 0.0;
  double max = 0.0;
};

/// By linear interpolation, as evaluation::percentile does. There must be at least one time.
Percentiles percentiles(std::vector<double> times);

/// The same figure of several runs: the median, and how far the runs lie apart.
struct Repeated {
  double median = 0.0;
  double min = 0.0;
  double max = 0.0;
};

/// There must be at least one value.
Repeated repeated(std::span<const double> values);

/// The exponent b of time = a size^b, by least squares of log(time) over log(size). Nothing without two sizes that
/// differ, and when a value is not positive and finite. Throws std::invalid_argument when the columns differ in length.
std::optional<double> growth_exponent(std::span<const double> sizes, std::span<const double> times);

}  // namespace dynamic_icp::speed
