// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <memory_resource>
#include <span>
#include <vector>

namespace dynamic_icp::tracking {

// Memory that costs nothing from scan to scan: on the stack, and that of the scan before.

/// Memory of `kBytes` on the stack for arrays that live no longer than it; the heap gives what goes beyond.
template <std::size_t kBytes>
class StackMemory {
 public:
  [[nodiscard]] std::pmr::memory_resource* resource() { return &resource_; }

 private:
  alignas(std::max_align_t) std::array<std::byte, kBytes> bytes_;
  std::pmr::monotonic_buffer_resource resource_{bytes_.data(), bytes_.size()};
};

/// Gives a vector that is used again room for `count` elements, and for more: numbers that vary from scan to scan soon
/// ask for no memory any more.
template <typename T>
void make_room(std::vector<T>& values, std::size_t count) {
  if (values.capacity() < count) {
    values.reserve(std::bit_ceil(count));
  }
}

/// Gives a vector that is used again `count` elements of this value.
template <typename T>
void refill(std::vector<T>& values, std::size_t count, const T& value) {
  make_room(values, count);
  values.assign(count, value);
}

/// The same with the elements of another array.
template <typename T>
void refill(std::vector<T>& values, std::span<const T> others) {
  make_room(values, others.size());
  values.assign(others.begin(), others.end());
}

}  // namespace dynamic_icp::tracking
