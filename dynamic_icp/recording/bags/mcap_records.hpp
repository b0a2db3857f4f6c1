// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dynamic_icp/recording/bags/bag.hpp"
#include "dynamic_icp/recording/bags/byte_source.hpp"

// The records of MCAP (mcap.dev/spec): one byte says which, eight how many bytes follow.
namespace dynamic_icp::bags {

constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";

enum class McapOp : std::uint8_t {
  kHeader = 1,
  kFooter = 2,
  kSchema = 3,
  kChannel = 4,
  kMessage = 5,
  kChunk = 6,
  kMessageIndex = 7,
  kChunkIndex = 8,
  kStatistics = 11,
  kDataEnd = 15
};

struct McapRecord {
  static constexpr std::uint64_t kHeadBytes = 9;

  std::uint64_t at = 0;
  McapOp op = McapOp::kHeader;
  std::uint64_t content_at = 0;
  std::uint64_t size = 0;

  [[nodiscard]] std::uint64_t end() const { return content_at + size; }
};

/// The record that begins at a place; it may go beyond the end of the source by as much as a length can state. Throws
/// Damage.
McapRecord mcap_record(ByteSource& source, std::uint64_t at);

/// A reader of the content of a record, all of which is there; throws Damage otherwise, or where it is longer than such
/// a record can be. The bytes stay as they are until the next use of the source.
ByteReader mcap_content(ByteSource& source, const McapRecord& record);

struct McapMessage {
  static constexpr std::uint64_t kHeadBytes = 22;

  std::uint16_t channel = 0;
  std::int64_t log_time_ns = 0;
  std::uint64_t data_at = 0;
  std::uint64_t data_size = 0;
};

/// The front of a message, all of which is there.
McapMessage mcap_message(ByteSource& source, const McapRecord& record);

struct McapChunkHeader {
  std::uint64_t size = 0;  ///< unpacked
  std::uint32_t crc = 0;   ///< of the unpacked bytes; 0: none
  std::string compression;
  std::uint64_t data_at = 0;
  std::uint64_t data_size = 0;
};

/// The front of a chunk, whose data may be cut.
McapChunkHeader mcap_chunk(ByteSource& source, const McapRecord& record);

struct McapChunkIndex {
  std::uint64_t at = 0;
  std::uint64_t length = 0;  ///< with the head of the record
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  std::vector<std::pair<std::uint16_t, std::uint64_t>> indices;  ///< channels, and where their message indices are
  std::uint64_t index_length = 0;                                ///< of these, behind the chunk
  std::uint64_t size = 0;                                        ///< unpacked
};

McapChunkIndex mcap_chunk_index(ByteSource& source, const McapRecord& record);

/// Schemas and channels, wherever they stand. Each channel has a copy of the description of its type: a small file, and
/// a stream that never ends, may ask for any amount of memory, and are refused beyond `kMaxBytes`.
class McapChannels {
 public:
  static constexpr std::uint64_t kMaxBytes = std::uint64_t{256} << 20U;

  void add_schema(ByteReader content);

  /// Throws Damage where its schema is unknown.
  void add_channel(ByteReader content);

  [[nodiscard]] bool has(std::uint16_t channel) const { return channels_.contains(channel); }
  void count(std::uint16_t channel, std::uint64_t messages) { channels_.at(channel).messages += messages; }
  [[nodiscard]] const std::map<std::uint64_t, Topic>& channels() const { return channels_; }

 private:
  struct Schema {
    std::string type;
    std::string data;
  };

  /// Throws Damage where all that is kept of them becomes more than any recording describes.
  void keep(const ByteReader& content, std::uint64_t bytes);

  std::uint64_t kept_ = 0;  ///< bytes of names and descriptions
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint64_t, Topic> channels_;
};

/// Times beyond what 64 bits with a sign hold are damage.
std::int64_t mcap_time(ByteReader& content);

}  // namespace dynamic_icp::bags
