// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace dynamic_icp {

/// A limited number of threads that run loops over fixed blocks. It is passed to whoever needs it: there is no global
/// setting, and two objects with different limits do not disturb each other.
///
/// Why blocks: the borders of the blocks depend on the length of the loop alone, never on the number of threads. Sums
/// formed per block and added in the order of the blocks are therefore the same bits for any number of threads.
class Workers {
 public:
  /// `threads` = 0 takes as many as the machine has. Throws std::invalid_argument when negative.
  explicit Workers(int threads = 0);
  ~Workers();
  Workers(Workers&&) noexcept;
  Workers& operator=(Workers&&) noexcept;

  [[nodiscard]] int threads() const;

  /// Calls body(block, begin, end) once for each block [begin, end) of `block_size` indices that covers [0, n); blocks
  /// may run at the same time. The first exception thrown by a body is thrown again here. A loop started from inside a
  /// body runs on the thread that starts it.
  void for_blocks(std::size_t n, std::size_t block_size,
                  const std::function<void(std::size_t block, std::size_t begin, std::size_t end)>& body) const;

  /// Calls body(i) for each i in [0, n), in blocks of `block_size`.
  template <class Body>
  void for_each(std::size_t n, std::size_t block_size, const Body& body) const {
    for_blocks(n, block_size, [&body](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        body(i);
      }
    });
  }

  /// The sum of block_sum(begin, end) over all blocks, added to `zero` in the order of the blocks.
  template <class Sum, class BlockSum>
  [[nodiscard]] Sum sum_blocks(std::size_t n, std::size_t block_size, Sum zero, const BlockSum& block_sum) const {
    std::vector<Sum> parts(block_count(n, block_size), zero);
    for_blocks(n, block_size,
               [&](std::size_t block, std::size_t begin, std::size_t end) { parts[block] = block_sum(begin, end); });
    for (const Sum& part : parts) {
      zero += part;
    }
    return zero;
  }

  /// Number of blocks of `block_size` that cover n indices.
  static constexpr std::size_t block_count(std::size_t n, std::size_t block_size) {
    return (n + block_size - 1) / block_size;
  }

 private:
  class Pool;
  std::unique_ptr<Pool> pool_;
};

}  // namespace dynamic_icp
