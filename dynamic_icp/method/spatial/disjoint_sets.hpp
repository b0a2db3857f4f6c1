// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace dynamic_icp::spatial {

/// The numbers [0, n) in disjoint sets, each known by one of its members. At first every number is alone.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n = 0) { reset(n); }

  /// The numbers [0, n), each alone, in the memory of those before.
  void reset(std::size_t n) {
    parent_.reserve(std::bit_ceil(n));  // with room for a few more the next time
    size_.reserve(std::bit_ceil(n));
    parent_.resize(n);
    size_.resize(n);
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
    std::fill(size_.begin(), size_.end(), 1u);
    count_ = n;
  }

  /// Number of sets.
  [[nodiscard]] std::size_t count() const { return count_; }

  /// The member by which the set of `x` is known.
  std::uint32_t find(std::uint32_t x) {
    while (parent_[x] != x) {
      parent_[x] = parent_[parent_[x]];  // halves the path for the next time
      x = parent_[x];
    }
    return x;
  }

  /// Number of members of the set that is known by `root`.
  [[nodiscard]] std::uint32_t size(std::uint32_t root) const { return size_[root]; }

  /// Unites the sets of `a` and `b`; false when they are one set already. The larger set keeps its member.
  bool unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a == b) {
      return false;
    }
    if (size_[a] < size_[b]) {
      std::swap(a, b);
    }
    parent_[b] = a;
    size_[a] += size_[b];
    --count_;
    return true;
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint32_t> size_;
  std::size_t count_ = 0;
};

}  // namespace dynamic_icp::spatial
