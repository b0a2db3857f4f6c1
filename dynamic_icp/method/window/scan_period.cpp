// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/scan_period.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

#include "dynamic_icp/method/base/quantile.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"

namespace dynamic_icp::window {
namespace {

// A period is seen in so many stamps, and looked for in so many.
constexpr std::size_t kMinStamps = 10;
constexpr std::size_t kMaxStamps = 50;

// Of a period: what is farther from a whole number of them follows none.
constexpr double kFarFromWhole = 0.3;

/// How many periods are nearest to a time; nothing where it is no whole number of them.
std::optional<double> whole_periods(double time_s, double period_s) {
  const double periods = time_s / period_s;
  const double whole = std::round(periods);
  return whole >= 1.0 && std::abs(periods - whole) < kFarFromWhole ? std::optional(whole) : std::nullopt;
}

}  // namespace

std::optional<KnownValue> ScanPeriod::add(double stamp_s) {
  if (!stamps_s_.empty() && stamp_s <= stamps_s_.back()) {
    return std::nullopt;
  }
  const std::optional<KnownValue> result =
      stamps_s_.size() < kMinStamps ? std::nullopt : expected(stamp_s - stamps_s_.back());
  if (stamps_s_.size() == kMaxStamps) {
    stamps_s_.erase(stamps_s_.begin());
  }
  stamps_s_.push_back(stamp_s);
  return result;
}

std::optional<KnownValue> ScanPeriod::expected(double interval_s) const {
  std::vector<double> intervals_s;
  for (std::size_t k = 1; k < stamps_s_.size(); ++k) {
    intervals_s.push_back(stamps_s_[k] - stamps_s_[k - 1]);
  }
  const double usual_s = median(intervals_s);
  std::vector<double> numbers = {0.0};
  for (std::size_t k = 1; k < stamps_s_.size(); ++k) {
    const std::optional<double> periods = whole_periods(stamps_s_[k] - stamps_s_[k - 1], usual_s);
    if (!periods) {
      return std::nullopt;
    }
    numbers.push_back(numbers.back() + *periods);
  }
  const auto n = static_cast<double>(numbers.size());
  double mean_number = 0.0;
  double mean_s = 0.0;  // after the first
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    mean_number += numbers[k] / n;
    mean_s += (stamps_s_[k] - stamps_s_[0]) / n;
  }
  double squares = 0.0;
  double products = 0.0;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    squares += (numbers[k] - mean_number) * (numbers[k] - mean_number);
    products += (numbers[k] - mean_number) * (stamps_s_[k] - stamps_s_[0] - mean_s);
  }
  const double period_s = products / squares;
  const std::optional<double> periods = whole_periods(interval_s, period_s);
  if (!periods) {
    return std::nullopt;
  }
  double residuals = 0.0;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const double residual = stamps_s_[k] - stamps_s_[0] - mean_s - period_s * (numbers[k] - mean_number);
    residuals += residual * residual;
  }
  return KnownValue{*periods * period_s, *periods * *periods * residuals / (n - 2.0) / squares};
}

void ScanPeriod::state(StateArchive& archive) {
  archive(stamps_s_);
  archive.require(stamps_s_.size() <= kMaxStamps && std::ranges::is_sorted(stamps_s_, std::less_equal<>()),
                  "the stamps of a period");
}

}  // namespace dynamic_icp::window
