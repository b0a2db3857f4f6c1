// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/scan_limits.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "dynamic_icp/method/base/quantile.hpp"

namespace dynamic_icp {
namespace {

constexpr std::size_t kMaxSamples = 2000;
constexpr double kMinMargin_s = 0.1;

}  // namespace

TimeWindow plausible_times(const Column& times_s) {
  std::vector<double> sample;
  const std::size_t stride = (times_s.size() + kMaxSamples - 1) / kMaxSamples;
  for (std::size_t i = 0; i < times_s.size(); i += stride) {
    if (std::abs(times_s[i]) <= kMaxPointTime_s) {
      sample.push_back(times_s[i]);
    }
  }
  if (sample.empty()) {
    return {-kMaxPointTime_s, kMaxPointTime_s};
  }
  const double low = quantile(sample, 0.05);
  const double high = quantile(std::move(sample), 0.95);
  const double margin = std::max(kMinMargin_s, high - low);
  return {std::max(low - margin, -kMaxPointTime_s), std::min(high + margin, kMaxPointTime_s)};
}

}  // namespace dynamic_icp
