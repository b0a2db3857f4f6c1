// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace dynamic_icp::spatial {

/// Numbers keys 0, 1, ... in the order in which they first come: a hash table by open addressing in one array that is
/// at most half full.
class KeyNumbers {
 public:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// With room for `expected` keys; grows as needed.
  explicit KeyNumbers(std::size_t expected = 0) : slots_(std::bit_ceil(std::max(kFewestSlots, 2 * expected))) {}

  /// The number of a key, a new one if it never came.
  std::uint32_t number_of(std::uint64_t key) {
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
  [[nodiscard]] std::uint32_t find(std::uint64_t key) const { return slots_[slot_of(key)].number; }

  [[nodiscard]] std::size_t count() const { return count_; }

  /// Forgets all keys but keeps the memory.
  void clear() {
    slots_.assign(slots_.size(), Slot{});
    count_ = 0;
  }

 private:
  static constexpr std::size_t kFewestSlots = 1024;

  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t number = kNone;
  };

  /// Spreads neighbouring keys over the slots.
  static std::uint64_t mix(std::uint64_t key) {
    key ^= key >> 31;
    key *= 0x9e3779b97f4a7c15U;
    return key ^ key >> 29;
  }

  /// Where the key stands, or where it would stand.
  [[nodiscard]] std::size_t slot_of(std::uint64_t key) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = mix(key) & mask;
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

}  // namespace dynamic_icp::spatial
