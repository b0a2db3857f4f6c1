// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "dynamic_icp/recording/bags/bag.hpp"
#include "dynamic_icp/recording/bags/byte_source.hpp"
#include "dynamic_icp/recording/bags/chunk_cache.hpp"
#include "dynamic_icp/recording/bags/mcap_records.hpp"

namespace dynamic_icp::bags {

/// Chunks and messages of an MCAP file by their places. Thread-safe.
class McapPieces {
 public:
  explicit McapPieces(std::shared_ptr<const ReadableBytes> file) : file_(std::move(file)) {}

  [[nodiscard]] const ReadableBytes& file() const { return *file_; }

  /// The content of a chunk, kept for a while. Throws Damage where it is none, or not all of it is there.
  [[nodiscard]] ChunkCache::Content chunk(const McapRecord& record) const;

  /// The same of a chunk that the end of the file cuts: what is there of its content.
  [[nodiscard]] std::string cut_chunk(const McapRecord& record) const;

  /// At least the first `bytes` bytes of a message where it has as many. `topic_of`: the topic of each channel; `name`:
  /// of the topic of the entry. Throws Damage where there is no such message.
  [[nodiscard]] std::string message(const MessageEntry& entry, const std::map<std::uint64_t, std::uint32_t>& topic_of,
                                    const std::string& name, std::size_t bytes) const;

 private:
  std::shared_ptr<const ReadableBytes> file_;
  mutable ChunkCache cache_;
};

}  // namespace dynamic_icp::bags
