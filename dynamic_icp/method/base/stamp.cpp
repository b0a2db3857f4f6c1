// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/stamp.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

#include <fmt/format.h>

namespace dynamic_icp {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr int kDecimals = 9;

/// The digits of a decimal number and where its point stands, once sign and exponent are taken off.
struct Decimal {
  bool negative = false;
  std::string digits;
  int point = 0;  // number of digits before the decimal point; may lie outside [0, digits.size()]
};

std::optional<Decimal> split_decimal(std::string_view text) {
  Decimal result;
  std::size_t i = 0;
  if (i < text.size() && (text[i] == '+' || text[i] == '-')) {
    result.negative = text[i] == '-';
    ++i;
  }
  bool seen_point = false;
  for (; i < text.size(); ++i) {
    if (text[i] == '.' && !seen_point) {
      seen_point = true;
    } else if (text[i] >= '0' && text[i] <= '9') {
      result.digits.push_back(text[i]);
      if (!seen_point) {
        ++result.point;
      }
    } else {
      break;
    }
  }
  if (result.digits.empty()) {
    return std::nullopt;
  }
  if (i == text.size()) {
    return result;
  }
  if (text[i] != 'e' && text[i] != 'E') {
    return std::nullopt;
  }
  ++i;
  if (i < text.size() && text[i] == '+') {
    ++i;
  }
  int exponent = 0;
  const auto [end, fault] = std::from_chars(text.data() + i, text.data() + text.size(), exponent);
  if (fault != std::errc() || end != text.data() + text.size() || exponent < -1000 || exponent > 1000) {
    return std::nullopt;
  }
  result.point += exponent;
  return result;
}

}  // namespace

double seconds_between(Stamp earlier, Stamp later) {
  // Unsigned: the difference of two stamps may need one bit more than a stamp.
  const bool in_order = later >= earlier;
  const auto from = static_cast<std::uint64_t>((in_order ? earlier : later).ns);
  const auto to = static_cast<std::uint64_t>((in_order ? later : earlier).ns);
  const double seconds = static_cast<double>(to - from) / static_cast<double>(kNanosecondsPerSecond);
  return in_order ? seconds : -seconds;
}

std::optional<Stamp> parse_seconds(std::string_view text) {
  const std::optional<Decimal> decimal = split_decimal(text);
  if (!decimal) {
    return std::nullopt;
  }
  const auto digit = [&](int position) {
    const bool inside = position >= 0 && position < static_cast<int>(decimal->digits.size());
    return inside ? decimal->digits[static_cast<std::size_t>(position)] - '0' : 0;
  };
  std::int64_t ns = 0;
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  for (int position = std::min(0, decimal->point); position < decimal->point + kDecimals; ++position) {
    if (ns > (kMax - 9) / 10) {
      return std::nullopt;
    }
    ns = ns * 10 + digit(position);
  }
  if (digit(decimal->point + kDecimals) >= 5) {
    ++ns;
  }
  return Stamp{decimal->negative ? -ns : ns};
}

std::optional<Stamp> parse_unix_time(std::string_view digits) {
  std::int64_t number = 0;
  const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (fault != std::errc() || end != digits.data() + digits.size() || number < 0) {
    return std::nullopt;
  }
  std::int64_t unit_ns = 1;
  switch (digits.size()) {
    case 10:
      unit_ns = kNanosecondsPerSecond;
      break;
    case 13:
      unit_ns = 1'000'000;
      break;
    case 16:
      unit_ns = 1'000;
      break;
    case 19:
      break;
    default:
      return std::nullopt;
  }
  if (number > std::numeric_limits<std::int64_t>::max() / unit_ns) {
    return std::nullopt;
  }
  return Stamp{number * unit_ns};
}

std::string format_seconds(Stamp stamp) {
  // The magnitude as unsigned: the most negative stamp has no positive counterpart.
  const bool negative = stamp.ns < 0;
  const std::uint64_t magnitude =
      negative ? ~static_cast<std::uint64_t>(stamp.ns) + 1 : static_cast<std::uint64_t>(stamp.ns);
  return fmt::format("{}{}.{:09}", negative ? "-" : "", magnitude / kNanosecondsPerSecond,
                     magnitude % kNanosecondsPerSecond);
}

}  // namespace dynamic_icp
