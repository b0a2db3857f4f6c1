// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/spatial/cell_order.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace dynamic_icp::spatial {
namespace {

TEST(CellOrder, IsAStableSortByTheFirstItemOfEachCell) {
  std::mt19937_64 random(3);
  CellOrder order;  // used again: nothing of the last keys may be left
  for (const std::size_t n : {5000U, 0U, 1U, 300U}) {
    order.keys.resize(n);
    for (std::uint64_t& key : order.keys) {
      key = random() % 200;
    }
    order.sort();
    const auto first_of = [&](std::size_t i) {
      return std::find(order.keys.begin(), order.keys.end(), order.keys[i]) - order.keys.begin();
    };
    std::vector<std::size_t> sorted(n);
    std::iota(sorted.begin(), sorted.end(), 0U);
    std::ranges::stable_sort(sorted, [&](std::size_t a, std::size_t b) { return first_of(a) < first_of(b); });
    ASSERT_EQ(order.first.front(), 0U);
    ASSERT_EQ(order.first.back(), n);
    for (std::size_t place = 0; place < n; ++place) {
      const std::size_t item = sorted[place];
      EXPECT_EQ(order.place(item), place);
      EXPECT_EQ(order.cell[item], order.numbers.find(order.keys[item]));
      EXPECT_EQ(order.rank[item] == 0, first_of(item) == static_cast<std::ptrdiff_t>(item));
    }
  }
}

TEST(CellOrder, TellsWhereMostItemsAreCounted) {
  CellOrder order;
  for (const std::vector<std::uint64_t>& keys : {std::vector<std::uint64_t>{7, 5, 7, 5, 5, 7, 9, 7}, {3, 3, 3}, {}}) {
    order.keys = keys;
    order.sort();
    const auto is_counted = [](std::size_t item) { return item % 2 == 0; };
    order.count_items(is_counted);  // again: nothing of the last items is counted
    for (std::size_t c = 0; c < order.cells(); ++c) {
      int more = 0;
      for (std::size_t item = 0; item < keys.size(); ++item) {
        more += order.cell[item] != c ? 0 : is_counted(item) ? 1 : -1;
      }
      EXPECT_EQ(order.counted_most_of(c), more > 0) << "cell " << c << " of " << order.cells();
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::spatial
