// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/point_times.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace dynamic_icp::datasets {
namespace {

constexpr std::int64_t kMicrosecond = 1'000;
constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kSecond = 1'000'000'000;
constexpr double kUnixSeconds = 1e9;     // 2001
constexpr double kLongestSpan_s = 10.0;  // of a scan, in whatever unit
constexpr double kFarAway_s = 10.0;
constexpr double kNanosecond = 1e-9;

struct Range {
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -std::numeric_limits<double>::infinity();

  [[nodiscard]] bool empty() const { return smallest > largest; }
  [[nodiscard]] double span() const { return empty() ? 0.0 : largest - smallest; }
};

Range range_of(const formats::NpyArray& column) {
  Range range;
  for (const double value : formats::column_as_doubles(column)) {
    if (std::isfinite(value)) {
      range.smallest = std::min(range.smallest, value);
      range.largest = std::max(range.largest, value);
    }
  }
  return range;
}

struct UnitName {
  std::string_view ending;
  std::string_view name;
  std::int64_t ns;
};

constexpr std::array<UnitName, 6> kUnits = {{{"_ns", "nanoseconds", 1},
                                             {"_nsecs", "nanoseconds", 1},
                                             {"nanosecs_since_frame", "nanoseconds", 1},
                                             {"_us", "microseconds", kMicrosecond},
                                             {"_ms", "milliseconds", kMillisecond},
                                             {"_s", "seconds", kSecond}}};

std::string_view name_of(std::int64_t ns) {
  return std::find_if(kUnits.begin(), kUnits.end(), [&](const UnitName& unit) { return unit.ns == ns; })->name;
}

/// The unit in which a number this large is a time since 1970 (2001 to 2286).
std::int64_t unix_unit(double value) {
  return value >= 1e18 ? 1 : value >= 1e15 ? kMicrosecond : value >= 1e12 ? kMillisecond : kSecond;
}

/// Whether a scan that spans so many of a unit takes most of a period.
bool is_most_of(double period_s, double span, std::int64_t unit_ns) {
  const double span_s = kNanosecond * static_cast<double>(unit_ns) * span;
  return span_s >= 0.1 * period_s && span_s <= 2.0 * period_s;
}

std::int64_t unit_of_offsets(const formats::NpyArray& column, const Range& range, double period_s) {
  if (formats::is_float(column.type) && range.span() < kLongestSpan_s) {
    return kSecond;
  }
  for (const std::int64_t unit : {std::int64_t{1}, kMicrosecond, kMillisecond}) {
    if (is_most_of(period_s, range.span(), unit)) {
      return unit;
    }
  }
  return 1;
}

}  // namespace

TimeUnit time_unit(std::string_view name, const formats::NpyArray& column, double period_s) {
  const Range range = range_of(column);
  TimeUnit unit;
  // Integers so large cannot be nanoseconds after a stamp of some scan: 1e15 ns are 11 days.
  const bool is_unix = !range.empty() && range.smallest >= (formats::is_float(column.type) ? kUnixSeconds : 1e15);
  for (const UnitName& known : kUnits) {
    if (name.ends_with(known.ending)) {
      unit.ns = known.ns;
      unit.is_unix = is_unix;
      return unit;
    }
  }
  unit.is_unix = is_unix;
  unit.ns = is_unix ? unix_unit(range.smallest) : unit_of_offsets(column, range, period_s);
  unit.assumption = fmt::format("times of points in column '{}' are taken as {} {}: they are {} from {} to {}", name,
                                name_of(unit.ns), is_unix ? "since 1970" : "after the stamp of the scan",
                                formats::is_float(column.type) ? "floating-point numbers" : "integers",
                                range.empty() ? 0.0 : range.smallest, range.empty() ? 0.0 : range.largest);
  return unit;
}

std::vector<double> times_after(Stamp stamp, const formats::NpyArray& column, const TimeUnit& unit) {
  const double unit_s = kNanosecond * static_cast<double>(unit.ns);
  std::vector<double> times = formats::column_as_doubles(column);
  if (!unit.is_unix) {
    for (double& time : times) {
      // One rounding only where the number is in seconds already, and the same as of other readers where it is in ns.
      time = unit.ns == kSecond ? time : unit_s * time;
    }
    return times;
  }
  if (!formats::is_float(column.type)) {
    const std::vector<std::int64_t> exact = formats::column_as_integers(column);
    const std::int64_t smallest = exact.empty() ? 0 : *std::min_element(exact.begin(), exact.end());
    // Differences in unsigned numbers: exact where they are small, and defined where they are not.
    const double about_s = unit_s * static_cast<double>(smallest) - kNanosecond * static_cast<double>(stamp.ns);
    const auto after_stamp =
        static_cast<std::int64_t>(static_cast<std::uint64_t>(smallest) * static_cast<std::uint64_t>(unit.ns) -
                                  static_cast<std::uint64_t>(stamp.ns));
    const double begin_s = std::abs(about_s) <= kFarAway_s ? kNanosecond * static_cast<double>(after_stamp) : 0.0;
    for (std::size_t i = 0; i < times.size(); ++i) {
      const std::uint64_t since = static_cast<std::uint64_t>(exact[i]) - static_cast<std::uint64_t>(smallest);
      times[i] = begin_s + unit_s * static_cast<double>(since);
    }
    return times;
  }
  double zero = kNanosecond * static_cast<double>(stamp.ns);
  double smallest = std::numeric_limits<double>::infinity();
  for (const double time : times) {
    smallest = std::isfinite(time) ? std::min(smallest, unit_s * time) : smallest;
  }
  zero = std::abs(smallest - zero) <= kFarAway_s ? zero : smallest;
  for (double& time : times) {
    time = unit_s * time - zero;
  }
  return times;
}

}  // namespace dynamic_icp::datasets
