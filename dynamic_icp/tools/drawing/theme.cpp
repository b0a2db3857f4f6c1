// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/drawing/theme.hpp"

namespace dynamic_icp::drawing {
namespace {

constexpr std::size_t kDopplerBins = 21;

}  // namespace

Theme theme(Ground ground) {
  Theme colours;
  if (ground == Ground::kLight) {
    colours = {.background = "#ffffff",
               .panel = "#f7f8fa",
               .ink = "#1b2430",
               .muted = "#5d6878",
               .grid = "#e2e5ea",
               .truth = "#5d6878",
               .series = {},
               .doppler = {}};
  } else {
    colours = {.background = "#11161f",
               .panel = "#161d29",
               .ink = "#eef2f7",
               .muted = "#9aa6b6",
               .grid = "#293344",
               .truth = "#9aa6b6",
               .series = {},
               .doppler = {}};
  }
  colours.series = categorical_colours(ground);
  colours.doppler = diverging_bins(kDopplerBins, ground);
  return colours;
}

}  // namespace dynamic_icp::drawing
