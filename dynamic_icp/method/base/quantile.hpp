// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "dynamic_icp/method/base/selection.hpp"

namespace dynamic_icp {

/// Standard deviation of normal errors over the median of their absolute values.
inline constexpr double kSigmaPerMad = 1.4826;

/// The value in place round(share * (n - 1)) of the ascending values, share from 0 to 1; 0 of none. Unlike
/// evaluation::percentile it does not interpolate: what it gives was measured. Brings the values into another order.
inline double quantile_among(std::span<double> values, double share) {
  if (values.empty()) {
    return 0.0;
  }
  const auto place = static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  select_place(values, place);
  return values[place];
}

/// The same of values that stay as they are.
inline double quantile(std::vector<double> values, double share) { return quantile_among(values, share); }

/// The middle value, of an even number the upper of the two, so that it is a value that was measured; 0 of none.
inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

/// The middle value, of an even number the mean of the two, as it is usually defined; of at least one finite value.
/// Brings the values into another order.
inline double interpolated_median_among(std::span<double> values) {
  const std::size_t upper = values.size() / 2;
  select_place(values, upper);
  return values.size() % 2 == 1 ? values[upper]
                                : 0.5 * (values[upper] + *std::ranges::max_element(values.first(upper)));
}

}  // namespace dynamic_icp
