// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <memory_resource>

namespace dynamic_icp::tracking {

/// Memory of `kBytes` on the stack for arrays that live no longer than it; the heap gives what goes beyond.
template <std::size_t kBytes>
class StackMemory {
 public:
  [[nodiscard]] std::pmr::memory_resource* resource() { return &resource_; }

 private:
  alignas(std::max_align_t) std::array<std::byte, kBytes> bytes_;
  std::pmr::monotonic_buffer_resource resource_{bytes_.data(), bytes_.size()};
};

}  // namespace dynamic_icp::tracking
