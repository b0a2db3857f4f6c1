// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

// Counts what a test program asks the heap for, in all of its threads. Replaces operator new: one source of a program
// may include it.
namespace dynamic_icp {

inline std::atomic<std::size_t> allocation_count{0};
inline std::atomic<std::size_t> largest_allocation{0};  ///< bytes

}  // namespace dynamic_icp

[[gnu::noinline]] void* operator new(std::size_t bytes) {
  ++dynamic_icp::allocation_count;
  std::size_t before = dynamic_icp::largest_allocation;
  while (bytes > before && !dynamic_icp::largest_allocation.compare_exchange_weak(before, bytes)) {
  }
  if (void* memory = std::malloc(bytes)) {
    return memory;
  }
  throw std::bad_alloc();
}

// Also this one: what it returns comes to the operator delete below.
[[gnu::noinline]] void* operator new(std::size_t bytes, const std::nothrow_t& /*tag*/) noexcept {
  try {
    return operator new(bytes);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
