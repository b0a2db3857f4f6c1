// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/drawing/colour_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

namespace dynamic_icp::drawing {
namespace {

/// Five colours at -1, -1/2, 0, 1/2 and 1, joined linearly.
using Stops = std::array<Rgb, 5>;

constexpr Stops kOnLight = {{{8, 64, 156}, {62, 128, 210}, {196, 199, 204}, {228, 104, 66}, {170, 20, 20}}};
constexpr Stops kOnDark = {{{105, 200, 255}, {64, 146, 220}, {82, 89, 101}, {222, 104, 62}, {255, 158, 92}}};

constexpr Stops kSequential = {{{32, 20, 76}, {45, 95, 138}, {47, 163, 135}, {166, 215, 91}, {253, 246, 192}}};

std::uint8_t mixed(std::uint8_t a, std::uint8_t b, double share) {
  return static_cast<std::uint8_t>(std::lround((1.0 - share) * a + share * b));
}

/// The colour at 0 (first stop) to 1 (last stop); NaN gives the middle.
Rgb between_stops(const Stops& stops, double value) {
  const double place = 4.0 * (std::isnan(value) ? 0.5 : std::clamp(value, 0.0, 1.0));
  const auto below = std::min<std::size_t>(static_cast<std::size_t>(place), stops.size() - 2);
  return mix(stops[below], stops[below + 1], place - static_cast<double>(below));
}

}  // namespace

std::string css(Rgb colour) { return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue); }

Rgb diverging_colour(double value, Ground ground) {
  return between_stops(ground == Ground::kLight ? kOnLight : kOnDark, 0.5 * (value + 1.0));
}

Rgb sequential_colour(double value) { return between_stops(kSequential, value); }

Rgb mix(Rgb a, Rgb b, double share) {
  return {mixed(a.red, b.red, share), mixed(a.green, b.green, share), mixed(a.blue, b.blue, share)};
}

Rgb rgb(const std::string& css) {
  unsigned red = 0;
  unsigned green = 0;
  unsigned blue = 0;
  if (std::sscanf(css.c_str(), "#%2x%2x%2x", &red, &green, &blue) != 3) {
    return {};
  }
  return {static_cast<std::uint8_t>(red), static_cast<std::uint8_t>(green), static_cast<std::uint8_t>(blue)};
}

std::vector<std::string> diverging_bins(std::size_t count, Ground ground) {
  std::vector<std::string> colours;
  for (std::size_t k = 0; k < count; ++k) {
    const double value = count < 2 ? 0.0 : 2.0 * static_cast<double>(k) / static_cast<double>(count - 1) - 1.0;
    colours.push_back(css(diverging_colour(value, ground)));
  }
  return colours;
}

std::size_t diverging_bin(double value, double limit, std::size_t count) {
  const double share = value / limit;
  const double bounded = std::isnan(share) ? 0.0 : std::clamp(share, -1.0, 1.0);
  return static_cast<std::size_t>(std::lround(0.5 * (bounded + 1.0) * static_cast<double>(count - 1)));
}

const std::vector<std::string>& categorical_colours(Ground ground) {
  static const std::vector<std::string> on_light = {"#0072b2", "#b83a00", "#009e73", "#d99400",
                                                    "#cc79a7", "#4aa3d8", "#6b4fa0", "#555555"};
  static const std::vector<std::string> on_dark = {"#56b4e9", "#ff8f4a", "#2fc79a", "#f0c419",
                                                   "#e79cc4", "#9fd3f5", "#b39ddb", "#c9ced6"};
  return ground == Ground::kLight ? on_light : on_dark;
}

}  // namespace dynamic_icp::drawing
