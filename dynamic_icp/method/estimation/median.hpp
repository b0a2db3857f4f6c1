// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace dynamic_icp::estimation {

/// Standard deviation of normal errors over the median of their absolute values.
inline constexpr double kDeviationPerMad = 1.4826;

/// The middle value, of an even number the upper one; there must be one.
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace dynamic_icp::estimation
