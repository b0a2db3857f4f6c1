// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/method/base/stamp.hpp"

namespace dynamic_icp::bags {

struct McapSettings {
  std::string profile;                   ///< "" : none of the well-known ones
  std::string library = "dynamic-icp";   ///< what wrote the file
  std::size_t chunk_bytes = 4UL << 20U;  ///< a chunk is closed once its records take so many, not compressed
  int zstd_level = 1;                    ///< of libzstd; 0: chunks are not compressed
};

/// How messages of some channels are to be read: "foxglove.PointCloud", "protobuf", a FileDescriptorSet.
struct McapSchema {
  std::string name;
  std::string encoding;
  std::string data;
};

struct McapChannel {
  std::uint16_t schema = 0;  ///< as add_schema gave it
  std::string topic;
  std::string message_encoding;  ///< "protobuf", "json", ...
  std::map<std::string, std::string> metadata;
};

/// Writes a recording of messages by the MCAP specification, version 0: header, chunks (with checksums, each followed
/// by the index of its messages), end of data, and a summary with schemas, channels, statistics and the places of
/// chunks and metadata, all with checksums. The same calls give the same bytes.
///
/// Memory: one chunk, and about 100 bytes for each one written. What the sink throws passes through; the writer is of
/// no use after that.
class McapWriter {
 public:
  /// Takes bytes in the order of the file.
  using Sink = std::function<void(std::string_view bytes)>;

  explicit McapWriter(Sink sink, McapSettings settings = {});

  /// Give the number of what was added. Throw std::length_error after 65535 of them.
  std::uint16_t add_schema(const McapSchema& schema);
  std::uint16_t add_channel(const McapChannel& channel);

  /// Appends a message. Throws DataError naming the topic when the time is before 1970: MCAP has no place for it. Times
  /// should not decrease, so that chunks do not overlap.
  void write(std::uint16_t channel, Stamp time, std::string_view message);

  /// A record beside the messages, for programs that look for its name.
  void add_metadata(const std::string& name, const std::map<std::string, std::string>& metadata);

  /// Writes what is left, and the summary; nothing may be added after it.
  void finish();

 private:
  struct IndexEntry {
    std::uint64_t time = 0;
    std::uint64_t offset = 0;  ///< within the chunk
  };
  struct TimeRange {
    std::uint64_t first = 0;
    std::uint64_t last = 0;
    bool empty = true;
    void add(std::uint64_t time);
  };
  struct ChannelState {
    std::string record;  ///< for the summary
    std::string topic;
    std::uint64_t messages = 0;
    std::vector<IndexEntry> index;  ///< of the open chunk
  };
  struct Group {
    std::uint8_t opcode = 0;
    std::string records;
  };

  void put(std::string_view bytes);
  void close_chunk();
  [[nodiscard]] std::string statistics() const;

  Sink sink_;
  McapSettings settings_;
  std::uint64_t position_ = 0;        ///< bytes written
  std::uint32_t data_crc_ = 0;        ///< of these
  std::vector<std::string> schemas_;  ///< records, for the summary
  std::vector<ChannelState> channels_;
  std::string chunk_;  ///< records of the open chunk
  TimeRange chunk_times_;
  TimeRange times_;
  std::uint64_t messages_ = 0;
  std::uint32_t chunks_ = 0;
  std::uint32_t metadata_ = 0;
  std::string chunk_indexes_;     ///< records, for the summary
  std::string metadata_indexes_;  ///< likewise
};

}  // namespace dynamic_icp::bags
