// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace dynamic_icp::spatial {

/// Spreads neighbouring keys over all 64-bit numbers.
inline std::uint64_t mixed(std::uint64_t key) {
  key ^= key >> 31;
  key *= 0x9e3779b97f4a7c15U;
  return key ^ key >> 29;
}
inline std::uint64_t mixed(const std::array<std::int32_t, 3>& key) {
  std::uint64_t sum = 0;
  for (const std::int32_t part : key) {
    sum = (sum ^ static_cast<std::uint32_t>(part)) * 0x9e3779b97f4a7c15U;
    sum ^= sum >> 32;
  }
  return sum;
}

/// Numbers keys 0, 1, ... in the order in which they first come: a hash table by open addressing in one array that is
/// at most half full.
template <class Key>
class NumbersOf {
 public:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// With room for `expected` keys; grows as needed.
  explicit NumbersOf(std::size_t expected = 0) : slots_(std::bit_ceil(std::max(kMinSlots, 2 * expected))) {}

  /// The number of a key, a new one if it never came.
  std::uint32_t number_of(const Key& key) {
    Slot& slot = slots_[slot_of(key)];
    if (slot.number != kNone) {
      return slot.number;
    }
    const std::uint32_t number = count_++;
    slot = {key, number};
    if (2 * static_cast<std::size_t>(count_) > slots_.size()) {
      grow();
    }
    return number;
  }

  /// The number of a key, or kNone if it never came.
  [[nodiscard]] std::uint32_t find(const Key& key) const { return slots_[slot_of(key)].number; }

  [[nodiscard]] std::size_t count() const { return count_; }

  /// Forgets all keys but keeps the memory.
  void clear() {
    slots_.assign(slots_.size(), Slot{});
    count_ = 0;
  }

 private:
  static constexpr std::size_t kMinSlots = 1024;

  struct Slot {
    Key key{};
    std::uint32_t number = kNone;
  };

  /// Where the key stands, or where it would stand.
  [[nodiscard]] std::size_t slot_of(const Key& key) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = mixed(key) & mask;
    while (slots_[slot].number != kNone && slots_[slot].key != key) {
      slot = (slot + 1) & mask;
    }
    return slot;
  }

  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    std::swap(old, slots_);
    for (const Slot& slot : old) {
      if (slot.number != kNone) {
        slots_[slot_of(slot.key)] = slot;
      }
    }
  }

  std::vector<Slot> slots_;
  std::uint32_t count_ = 0;
};

using KeyNumbers = NumbersOf<std::uint64_t>;

}  // namespace dynamic_icp::spatial
