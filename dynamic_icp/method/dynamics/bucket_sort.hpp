// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace dynamic_icp::dynamics {

/// A number of buckets in which `n` items, evenly spread, lie nearly alone.
inline std::size_t bucket_count_for(std::size_t n) { return std::bit_ceil(std::clamp<std::size_t>(n, 1, 1 << 16)); }

/// Sorts fewer than 2^32 items: they are dealt into buckets, where few are left to compare. Comparisons among many take
/// most of their time because nobody can predict their outcome.
///
/// `bucket(item)` is in [0, bucket_count) and never smaller for an item that `is_less` puts later. The outcome is that
/// of std::sort, and so is the time if all items lie in one bucket.
template <class T, class Bucket, class IsLess>
void bucket_sort(std::vector<T>& items, std::size_t bucket_count, const Bucket& bucket, const IsLess& is_less) {
  std::vector<std::uint32_t> buckets(items.size());
  std::vector<std::uint32_t> ends(bucket_count, 0);
  for (std::size_t i = 0; i < items.size(); ++i) {
    buckets[i] = static_cast<std::uint32_t>(bucket(items[i]));
    ++ends[buckets[i]];
  }
  std::uint32_t sum = 0;
  for (std::uint32_t& end : ends) {
    sum += end;
    end = sum - end;  // where the bucket begins, until it is filled
  }
  std::vector<T> dealt(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    dealt[ends[buckets[i]]++] = items[i];
  }
  auto begin = dealt.begin();
  for (const std::uint32_t end : ends) {
    const auto last = dealt.begin() + static_cast<std::ptrdiff_t>(end);
    if (last - begin > 1) {
      std::sort(begin, last, is_less);
    }
    begin = last;
  }
  items = std::move(dealt);
}

}  // namespace dynamic_icp::dynamics
