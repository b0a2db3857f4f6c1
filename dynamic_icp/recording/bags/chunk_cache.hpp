// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <list>
#include <memory>
#include <mutex>
#include <string>

namespace dynamic_icp::bags {

/// The last unpacked chunks of a file: message after message, none is unpacked twice. Thread-safe; who asks for a chunk
/// that is being unpacked waits for it.
class ChunkCache {
 public:
  using Content = std::shared_ptr<const std::string>;

  /// `max_bytes`: what is kept beyond the last chunk.
  explicit ChunkCache(std::size_t max_bytes = kMaxBytes) : max_bytes_(max_bytes) {}

  /// The chunk at a place, from `unpack` where it is not kept. What `unpack` throws is thrown.
  Content get(std::uint64_t place, const std::function<std::string()>& unpack);

  static constexpr std::size_t kMaxBytes = std::size_t{32} << 20U;

 private:
  struct Kept {
    std::uint64_t place;
    std::shared_future<Content> content;
    std::size_t bytes;  ///< 0 while it is being unpacked
  };

  void finish(std::uint64_t place, std::size_t bytes);
  void forget(std::uint64_t place);

  std::size_t max_bytes_;
  std::mutex mutex_;
  std::list<Kept> kept_;  // the last used first
};

}  // namespace dynamic_icp::bags
