// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/spatial/cell_order.hpp"

#include <numeric>

namespace dynamic_icp::spatial {

void CellOrder::sort() {
  cell.reserve(keys.capacity());  // where that grows in good time, so do these
  rank.reserve(keys.capacity());
  cell.resize(keys.size());
  rank.resize(keys.size());
  numbers.clear();
  first.assign(1, 0);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    // Items that follow each other often share a cell.
    const bool same = i > 0 && keys[i] == keys[i - 1];
    cell[i] = same ? cell[i - 1] : numbers.number_of(keys[i]);
    if (cell[i] == cells()) {
      first.push_back(0);
    }
    rank[i] = first[cell[i] + 1]++;
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
}

}  // namespace dynamic_icp::spatial
