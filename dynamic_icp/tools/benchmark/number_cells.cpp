// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/number_cells.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string>

#include <fmt/format.h>

namespace dynamic_icp::benchmark {
namespace {

std::string text_of(const Number& number, const Style& style) {
  if (number.failed) {
    return "failed";
  }
  if (!number.value) {
    return "-";
  }
  return style.percent ? fmt::format("{:.{}f}%", 100.0 * *number.value, style.decimals)
                       : fmt::format("{:.{}f}", *number.value, style.decimals);
}

/// What is written, turned so that less is better; infinite where there is no number.
double rank_of(const Number& number, const std::string& text, Best best) {
  if (!number.value) {
    return std::numeric_limits<double>::infinity();
  }
  const double written = std::strtod(text.c_str(), nullptr);
  return best == Best::kHighest ? -written : written;
}

}  // namespace

std::vector<TableCell> cells_of(const std::vector<Number>& numbers, const Style& style) {
  std::vector<TableCell> cells;
  std::vector<double> ranks;
  for (const Number& number : numbers) {
    cells.push_back({text_of(number, style), Emphasis::kNone});
    ranks.push_back(rank_of(number, cells.back().text, style.best));
  }
  std::vector<double> distinct = ranks;
  std::erase(distinct, std::numeric_limits<double>::infinity());
  if (style.best == Best::kNone || distinct.size() < 2) {
    return cells;
  }
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (ranks[i] == distinct[0]) {
      cells[i].emphasis = Emphasis::kBest;
    } else if (distinct.size() > 1 && ranks[i] == distinct[1]) {
      cells[i].emphasis = Emphasis::kSecond;
    }
  }
  return cells;
}

}  // namespace dynamic_icp::benchmark
