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

/// The number of flags of [begin, end) that are not 0, eight at a time.
inline std::size_t count_flagged(std::span<const std::uint8_t> flags, std::size_t begin, std::size_t end) {
  constexpr std::uint64_t kOnes = 0x0101010101010101u;
  constexpr std::uint64_t kLow = 0x7fu * kOnes;  // all bits of each flag but the highest
  std::size_t count = 0;
  std::size_t i = begin;
  for (; i + sizeof(std::uint64_t) <= end; i += sizeof(std::uint64_t)) {
    std::uint64_t together = 0;
    std::memcpy(&together, &flags[i], sizeof(together));
    const std::uint64_t is_set = ((((together & kLow) + kLow) | together) >> 7) & kOnes;
    count += (is_set * kOnes) >> 56;
  }
  for (; i < end; ++i) {
    count += flags[i] != 0 ? 1 : 0;
  }
  return count;
}

}  // namespace dynamic_icp::tracking
