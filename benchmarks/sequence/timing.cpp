// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "benchmarks/sequence/timing.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "dynamic_icp/recording/evaluation/statistics.hpp"

namespace dynamic_icp::speed {
namespace {

bool is_positive(double value) { return std::isfinite(value) && value > 0.0; }

}  // namespace

double median(std::vector<double> values) { return percentiles(std::move(values)).p50; }

Percentiles percentiles(std::vector<double> times) {
  if (times.empty()) {
    throw std::invalid_argument("no times");
  }
  std::sort(times.begin(), times.end());
  return {evaluation::percentile(times, 50.0), evaluation::percentile(times, 95.0), evaluation::percentile(times, 99.0),
          times.back()};
}

Repeated repeated(std::span<const double> values) {
  const double middle = median({values.begin(), values.end()});
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {middle, *low, *high};
}

std::optional<double> growth_exponent(std::span<const double> sizes, std::span<const double> times) {
  if (sizes.size() != times.size()) {
    throw std::invalid_argument("sizes and times differ in length");
  }
  if (!std::all_of(sizes.begin(), sizes.end(), is_positive) || !std::all_of(times.begin(), times.end(), is_positive)) {
    return std::nullopt;
  }
  const auto n = static_cast<double>(sizes.size());
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    mean_x += std::log(sizes[i]) / n;
    mean_y += std::log(times[i]) / n;
  }
  double xx = 0.0;
  double xy = 0.0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double x = std::log(sizes[i]) - mean_x;
    xx += x * x;
    xy += x * (std::log(times[i]) - mean_y);
  }
  // Sizes that differ by less than a part in a million are the same size.
  return xx > 1e-12 ? std::optional(xy / xx) : std::nullopt;
}

}  // namespace dynamic_icp::speed
