// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/json_text.hpp"

#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

namespace dynamic_icp::report {
namespace {

/// What a text of few digits means as a number is what is written again.
Json number_of(const std::string& text) {
  const double value = std::strtod(text.c_str(), nullptr);
  constexpr double kWhole = 1e15;
  if (value == std::round(value) && std::abs(value) < kWhole) {
    return static_cast<std::int64_t>(value);  // "3" instead of "3.0"
  }
  return value;
}

}  // namespace

Json rounded(double value, int decimals) {
  return std::isfinite(value) ? number_of(fmt::format("{:.{}f}", value, decimals)) : Json(nullptr);
}

Json significant(double value, int digits) {
  return std::isfinite(value) ? number_of(fmt::format("{:.{}g}", value, digits)) : Json(nullptr);
}

std::string embeddable(const Json& value) {
  std::string text;
  for (const char c : value.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    text += c == '<' || c == '>' || c == '&' ? fmt::format("\\u{:04x}", static_cast<int>(c)) : std::string(1, c);
  }
  return text;
}

}  // namespace dynamic_icp::report
