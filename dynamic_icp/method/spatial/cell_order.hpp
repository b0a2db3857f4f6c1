// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dynamic_icp/method/spatial/key_numbers.hpp"

namespace dynamic_icp::spatial {

/// Items sorted by the keys of their cells. Cells come in the order of their first items, items of one cell in their
/// own order. May be used again, so that no memory is asked for.
struct CellOrder {
  std::vector<std::uint64_t> keys;    ///< of each item; to be filled in before `sort`
  std::vector<std::uint32_t> cell;    ///< of each item
  std::vector<std::uint32_t> rank;    ///< of each item: how many items of its cell come before
  std::vector<std::uint32_t> first;   ///< cell c holds the places [first[c], first[c + 1])
  KeyNumbers numbers;                 ///< the cell of a key
  std::vector<std::uint32_t> counts;  ///< of each cell: its items that `count_items` counted

  /// Finds cells and places from the keys.
  void sort();

  [[nodiscard]] std::size_t cells() const { return first.size() - 1; }

  /// Where an item goes when all are sorted.
  [[nodiscard]] std::uint32_t place(std::size_t item) const { return first[cell[item]] + rank[item]; }

  /// Counts in each cell the items that `is_counted(item)` says.
  template <class IsCounted>
  void count_items(const IsCounted& is_counted) {
    counts.assign(cells(), 0);
    for (std::size_t item = 0; item < cell.size(); ++item) {
      if (is_counted(item)) {
        ++counts[cell[item]];
      }
    }
  }

  /// Whether these were more than half of the cell.
  [[nodiscard]] bool counted_most_of(std::size_t c) const { return 2 * counts[c] > first[c + 1] - first[c]; }
};

}  // namespace dynamic_icp::spatial
