// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>

namespace dynamic_icp {

/// The block of a loop that does little for each point.
inline constexpr std::size_t kPointBlock = 4096;

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
  /// may run at the same time. The first exception thrown by a body is thrown again here. A body may start loops of its
  /// own: who has nothing else to do takes part. Allocates nothing.
  template <class Body>
  void for_blocks(std::size_t n, std::size_t block_size, const Body& body) const {
    const auto run_block = [&](std::size_t block) {
      body(block, block * block_size, std::min(n, (block + 1) * block_size));
    };
    run(block_count(n, block_size), {&run_block, [](const void* callable, std::size_t block) {
                                       (*static_cast<const decltype(run_block)*>(callable))(block);
                                     }});
  }

  /// Calls body(i) for each i in [0, n), in blocks of `block_size`.
  template <class Body>
  void for_each(std::size_t n, std::size_t block_size, const Body& body) const {
    for_blocks(n, block_size, [&body](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        body(i);
      }
    });
  }

  /// The sum of block_sum(begin, end) over blocks of at least `block_size` indices, added to `zero` in the order of the
  /// blocks. There are at most `kMaxParts` blocks, so that their sums fit on the stack.
  template <class Sum, class BlockSum>
  [[nodiscard]] Sum sum_blocks(std::size_t n, std::size_t block_size, Sum zero, const BlockSum& block_sum) const {
    const std::size_t size = std::max(block_size, block_count(n, kMaxParts));
    std::array<Sum, kMaxParts> parts;
    for_blocks(n, size,
               [&](std::size_t block, std::size_t begin, std::size_t end) { parts[block] = block_sum(begin, end); });
    for (std::size_t block = 0; block < block_count(n, size); ++block) {
      zero += parts[block];
    }
    return zero;
  }

  /// Runs two tasks, at the same time where there are two threads. Who is done with one helps with the loops of the
  /// other.
  template <class First, class Second>
  void both(const First& first, const Second& second) const {
    for_blocks(2, 1, [&](std::size_t task, std::size_t, std::size_t) {
      if (task == 0) {
        first();
      } else {
        second();
      }
    });
  }

  /// Number of blocks of `block_size` that cover n indices.
  static constexpr std::size_t block_count(std::size_t n, std::size_t block_size) {
    return (n + block_size - 1) / block_size;
  }

 private:
  static constexpr std::size_t kMaxParts = 64;

  /// A reference to something that is called with the number of a block.
  struct BlockCall {
    const void* callable;
    void (*call)(const void* callable, std::size_t block);
  };

  void run(std::size_t blocks, const BlockCall& call) const;

  class Pool;
  std::unique_ptr<Pool> pool_;
};

}  // namespace dynamic_icp
