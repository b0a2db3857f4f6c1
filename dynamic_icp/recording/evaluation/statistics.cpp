// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace dynamic_icp::evaluation {

std::optional<Statistics> summarize(std::span<const double> errors) {
  if (errors.empty()) {
    return std::nullopt;
  }
  double sum = 0.0;
  double sum_of_squares = 0.0;
  for (const double error : errors) {
    sum += error;
    sum_of_squares += error * error;
  }
  if (!std::isfinite(sum) || !std::isfinite(sum_of_squares)) {
    return std::nullopt;
  }
  std::vector<double> ascending(errors.begin(), errors.end());
  std::sort(ascending.begin(), ascending.end());
  const auto count = static_cast<double>(errors.size());
  return Statistics{errors.size(),
                    std::sqrt(sum_of_squares / count),
                    sum / count,
                    percentile(ascending, 50.0),
                    percentile(ascending, 95.0),
                    ascending.back()};
}

double percentile(std::span<const double> ascending, double p) {
  if (ascending.empty() || !(p >= 0.0 && p <= 100.0)) {
    throw std::invalid_argument("percentile: expected at least one value and p from 0 to 100");
  }
  const double position = p / 100.0 * static_cast<double>(ascending.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, ascending.size() - 1);
  return ascending[below] + (position - static_cast<double>(below)) * (ascending[above] - ascending[below]);
}

std::optional<double> mean_of(std::span<const double> errors) {
  const std::optional<Statistics> statistics = summarize(errors);
  return statistics ? std::optional(statistics->mean) : std::nullopt;
}

}  // namespace dynamic_icp::evaluation
