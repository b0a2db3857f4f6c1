// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace dynamic_icp::tracking {

/// Calls visit(i) for each i of [begin, end) whose flag is not 0, ascending: eight at a time, for most of them are 0.
template <typename Visit>
void visit_flagged(std::span<const std::uint8_t> flags, std::size_t begin, std::size_t end, const Visit& visit) {
  constexpr std::size_t kTogether = sizeof(std::uint64_t);
  std::size_t i = begin;
  for (; i + kTogether <= end; i += kTogether) {
    std::uint64_t together = 0;
    std::memcpy(&together, &flags[i], kTogether);
    for (std::size_t k = i; together != 0 && k < i + kTogether; ++k) {
      if (flags[k] != 0) {
        visit(k);
      }
    }
  }
  for (; i < end; ++i) {
    if (flags[i] != 0) {
      visit(i);
    }
  }
}

}  // namespace dynamic_icp::tracking
