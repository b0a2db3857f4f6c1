// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace dynamic_icp {

/// A point in time in whole nanoseconds. A double cannot hold today's Unix time to better than 238 ns, so time stamps
/// stay integers from the file they come from to the file they go to.
struct Stamp {
  std::int64_t ns = 0;

  auto operator<=>(const Stamp&) const = default;
};

/// Seconds from `earlier` to `later`; the difference is formed in integers and is exact to the nanosecond for spans
/// up to 100 days.
double seconds_between(Stamp earlier, Stamp later);

/// Reads decimal seconds ("1724479779.384729506", "-0.5", "1.7e9", "0") without going through a double. Digits beyond
/// the ninth decimal are rounded half away from zero. Empty for anything that is not one number, or out of range.
std::optional<Stamp> parse_seconds(std::string_view text);

/// Reads Unix time as a whole number whose unit its length tells (dates from 2001 to 2286): 10 digits s, 13 ms, 16 us,
/// 19 ns. Empty for anything else, or out of range.
std::optional<Stamp> parse_unix_time(std::string_view digits);

/// Decimal seconds with exactly nine decimals, e.g. "-0.500000000"; `parse_seconds` gives the same stamp back.
std::string format_seconds(Stamp stamp);

}  // namespace dynamic_icp
