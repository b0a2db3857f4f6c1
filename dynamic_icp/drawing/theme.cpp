// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/drawing/theme.hpp"

#include <fmt/format.h>

namespace dynamic_icp::drawing {
namespace {

constexpr std::size_t kDopplerBins = 21;

std::vector<std::string> variables(const std::vector<std::string>& colours, const char* name) {
  std::vector<std::string> all;
  for (std::size_t k = 0; k < colours.size(); ++k) {
    all.push_back(fmt::format("var(--{}-{})", name, k));
  }
  return all;
}

std::string definitions(const std::vector<std::string>& colours, const char* name) {
  std::string text;
  for (std::size_t k = 0; k < colours.size(); ++k) {
    text += fmt::format("--{}-{}:{};", name, k, colours[k]);
  }
  return text;
}

}  // namespace

Theme theme(Ground ground) {
  Theme colours;
  if (ground == Ground::kLight) {
    colours = {.background = "#ffffff",
               .panel = "#f7f8fa",
               .ink = "#1b2430",
               .muted = "#5d6878",
               .grid = "#e2e5ea",
               .series = {},
               .doppler = {}};
  } else {
    colours = {.background = "#11161f",
               .panel = "#161d29",
               .ink = "#eef2f7",
               .muted = "#9aa6b6",
               .grid = "#293344",
               .series = {},
               .doppler = {}};
  }
  colours.series = categorical_colours(ground);
  colours.doppler = diverging_bins(kDopplerBins, ground);
  return colours;
}

Theme page_theme() {
  const Theme light = theme(Ground::kLight);
  return {.background = "var(--background)",
          .panel = "var(--panel)",
          .ink = "var(--ink)",
          .muted = "var(--muted)",
          .grid = "var(--grid)",
          .series = variables(light.series, "series"),
          .doppler = variables(light.doppler, "doppler")};
}

std::string css_variables(Ground ground) {
  const Theme colours = theme(ground);
  return fmt::format("--background:{};--panel:{};--ink:{};--muted:{};--grid:{};", colours.background, colours.panel,
                     colours.ink, colours.muted, colours.grid) +
         definitions(colours.series, "series") + definitions(colours.doppler, "doppler");
}

}  // namespace dynamic_icp::drawing
