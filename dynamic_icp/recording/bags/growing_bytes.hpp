// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "dynamic_icp/recording/bags/byte_source.hpp"

namespace dynamic_icp::bags {

/// When something was there, by a clock that never jumps.
using Arrival = std::chrono::steady_clock::time_point;

/// Bytes that become more. A thread of their own sees to it, so that it is known when they came however busy the rest
/// of the program is.
class GrowingBytes : public ReadableBytes {
 public:
  [[nodiscard]] std::uint64_t size() const override { return size_; }

  /// Waits until there are so many bytes, no more will come, or that long. Whether they are there. Throws DataError
  /// where they cannot come: the file became shorter, is gone or cannot be read.
  bool wait_for(std::uint64_t bytes, std::chrono::milliseconds longest);

  /// Whether no more will come: the end of a stream.
  [[nodiscard]] bool has_ended() const { return has_ended_; }

  /// When the bytes before a place were there; nothing where they were before anybody looked. Places must not go back.
  std::optional<Arrival> arrival(std::uint64_t place);

  /// Bytes before a place are not read again, and need not be kept.
  virtual void forget_before(std::uint64_t /*place*/) {}

  /// Bytes that are kept only because they may be read again.
  [[nodiscard]] virtual std::uint64_t kept() const { return 0; }

  /// Bytes behind those that are there are not wanted; who writes them should not notice.
  virtual void drain() {}

 protected:
  using ReadableBytes::ReadableBytes;

  void grow_to(std::uint64_t bytes, std::optional<Arrival> at);  ///< with the lock
  void end() { has_ended_ = true; }
  void fail(const std::string& why);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t wanted_ = 0;          ///< bytes that somebody waits for
  std::optional<std::string> fault_;  ///< why there will be no more

 private:
  struct Growth {
    std::uint64_t size;
    std::optional<Arrival> at;
  };

  std::atomic<std::uint64_t> size_ = 0;
  std::atomic<bool> has_ended_ = false;
  std::deque<Growth> growth_;
  std::optional<Arrival> last_arrival_;
};

/// A file that another program writes. Throws DataError where it cannot be read.
std::unique_ptr<GrowingBytes> growing_file(const std::filesystem::path& path);

/// What comes out of a descriptor, such as standard input, that stays open; `name` is for messages. It is read ahead up
/// to a limit, then whoever writes has to wait. Throws DataError where it cannot be read.
std::unique_ptr<GrowingBytes> growing_stream(int descriptor, const std::string& name);

}  // namespace dynamic_icp::bags
