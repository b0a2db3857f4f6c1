// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/number_cells.hpp"

#include <gtest/gtest.h>

namespace dynamic_icp::benchmark {
namespace {

constexpr Style kLowest{.decimals = 2, .best = Best::kLowest};
constexpr Style kHighest{.decimals = 2, .best = Best::kHighest};

/// The cells as "text", "text*" for the best and "text+" for the second.
std::vector<std::string> marked(const std::vector<Number>& numbers, const Style& style) {
  std::vector<std::string> texts;
  for (const TableCell& cell : cells_of(numbers, style)) {
    texts.push_back(cell.text);
    texts.back() += cell.emphasis == Emphasis::kBest ? "*" : cell.emphasis == Emphasis::kSecond ? "+" : "";
  }
  return texts;
}

using Texts = std::vector<std::string>;

TEST(NumberCells, BestAndSecondStandOut) {
  EXPECT_EQ(marked({{3.0}, {1.0}, {2.0}}, kLowest), (Texts{"3.00", "1.00*", "2.00+"}));
  EXPECT_EQ(marked({{3.0}, {1.0}, {2.0}}, kHighest), (Texts{"3.00*", "1.00", "2.00+"}));
  EXPECT_EQ(marked({{-3.0}, {1.0}}, kLowest), (Texts{"-3.00*", "1.00+"}));
  EXPECT_EQ(marked({{3.0}, {1.0}}, Style{}), (Texts{"3.00", "1.00"})) << "nothing is better";
}

TEST(NumberCells, WhatLooksEqualShares) {
  EXPECT_EQ(marked({{1.001}, {1.004}, {1.006}, {1.009}, {2.0}}, kLowest),
            (Texts{"1.00*", "1.00*", "1.01+", "1.01+", "2.00"}));
  EXPECT_EQ(marked({{1.0}, {1.0}}, kLowest), (Texts{"1.00*", "1.00*"}));
}

TEST(NumberCells, MissingAndFailedNeverStandOut) {
  EXPECT_EQ(marked({{}, {2.0}, {std::nullopt, true}, {1.0}}, kLowest), (Texts{"-", "2.00+", "failed", "1.00*"}));
  EXPECT_EQ(marked({{}, {2.0}, {std::nullopt, true}, {1.0}}, kHighest), (Texts{"-", "2.00*", "failed", "1.00+"}));
  EXPECT_EQ(marked({{}, {2.0}, {}}, kLowest), (Texts{"-", "2.00", "-"})) << "the only one is not the best";
  EXPECT_TRUE(cells_of({}, kLowest).empty());
}

TEST(NumberCells, PercentAreWrittenAsSuch) {
  EXPECT_EQ(marked({{0.998}, {1.0}}, Style{.decimals = 1, .percent = true, .best = Best::kHighest}),
            (Texts{"99.8%+", "100.0%*"}));
}

}  // namespace
}  // namespace dynamic_icp::benchmark
