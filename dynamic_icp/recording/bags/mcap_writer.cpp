// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// By https://mcap.dev/spec: numbers are little-endian; texts, arrays and maps begin with their length in bytes.
#include "dynamic_icp/recording/bags/mcap_writer.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <zstd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/bags/crc32.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"

namespace dynamic_icp::bags {
namespace {

using formats::append_value;

constexpr std::string_view kWriterMagic{"\x89MCAP0\r\n", 8};

/// Of the records that are written.
enum McapWriterOpcode : std::uint8_t {
  kWriteHeader = 0x01,
  kWriteFooter = 0x02,
  kWriteSchema = 0x03,
  kWriteChannel = 0x04,
  kWriteMessage = 0x05,
  kWriteChunk = 0x06,
  kWriteMessageIndex = 0x07,
  kWriteChunkIndex = 0x08,
  kWriteStatistics = 0x0B,
  kWriteMetadata = 0x0C,
  kWriteMetadataIndex = 0x0D,
  kWriteSummaryOffset = 0x0E,
  kWriteDataEnd = 0x0F,
};

void append_mcap_bytes(std::string& to, std::string_view bytes) {
  if (bytes.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw std::length_error(fmt::format("{} bytes are too long for a record of MCAP", bytes.size()));
  }
  append_value(to, static_cast<std::uint32_t>(bytes.size()));
  to += bytes;
}

void append_mcap_map(std::string& to, const std::map<std::string, std::string>& map) {
  std::string entries;
  for (const auto& [key, value] : map) {
    append_mcap_bytes(entries, key);
    append_mcap_bytes(entries, value);
  }
  append_mcap_bytes(to, entries);
}

/// The begin of a record whose content has so many bytes.
void append_mcap_begin(std::string& to, McapWriterOpcode opcode, std::size_t bytes) {
  append_value(to, static_cast<std::uint8_t>(opcode));
  append_value(to, static_cast<std::uint64_t>(bytes));
}

std::string mcap_record_bytes(McapWriterOpcode opcode, std::string_view content) {
  std::string record;
  record.reserve(1 + 8 + content.size());
  append_mcap_begin(record, opcode, content.size());
  record += content;
  return record;
}

std::string mcap_compressed(const std::string& bytes, int level) {
  std::string compressed(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size = ZSTD_compress(compressed.data(), compressed.size(), bytes.data(), bytes.size(), level);
  if (ZSTD_isError(size) != 0U) {
    throw std::runtime_error(fmt::format("zstd cannot compress {} bytes: {}", bytes.size(), ZSTD_getErrorName(size)));
  }
  compressed.resize(size);
  return compressed;
}

template <class Entry>
std::uint16_t next_mcap_number(const std::vector<Entry>& known, std::size_t first, const char* what) {
  if (known.size() + first > std::numeric_limits<std::uint16_t>::max()) {
    throw std::length_error(fmt::format("an MCAP file has at most 65535 {}", what));
  }
  return static_cast<std::uint16_t>(known.size() + first);
}

}  // namespace

void McapWriter::TimeRange::add(std::uint64_t time) {
  first = empty ? time : std::min(first, time);
  last = empty ? time : std::max(last, time);
  empty = false;
}

McapWriter::McapWriter(Sink sink, McapSettings settings) : sink_(std::move(sink)), settings_(std::move(settings)) {
  std::string begin(kWriterMagic);
  std::string header;
  append_mcap_bytes(header, settings_.profile);
  append_mcap_bytes(header, settings_.library);
  put(begin + mcap_record_bytes(kWriteHeader, header));
}

void McapWriter::put(std::string_view bytes) {
  data_crc_ = crc32(bytes, data_crc_);
  position_ += bytes.size();
  sink_(bytes);
}

std::uint16_t McapWriter::add_schema(const McapSchema& schema) {
  const std::uint16_t number = next_mcap_number(schemas_, 1, "schemas");  // 0: no schema
  std::string content;
  append_value(content, number);
  append_mcap_bytes(content, schema.name);
  append_mcap_bytes(content, schema.encoding);
  append_mcap_bytes(content, schema.data);
  schemas_.push_back(mcap_record_bytes(kWriteSchema, content));
  chunk_ += schemas_.back();
  return number;
}

std::uint16_t McapWriter::add_channel(const McapChannel& channel) {
  const std::uint16_t number = next_mcap_number(channels_, 0, "channels");
  std::string content;
  append_value(content, number);
  append_value(content, channel.schema);
  append_mcap_bytes(content, channel.topic);
  append_mcap_bytes(content, channel.message_encoding);
  append_mcap_map(content, channel.metadata);
  channels_.push_back({mcap_record_bytes(kWriteChannel, content), channel.topic, 0, {}});
  chunk_ += channels_.back().record;
  return number;
}

void McapWriter::write(std::uint16_t channel, Stamp time, std::string_view message) {
  ChannelState& state = channels_.at(channel);
  if (time.ns < 0) {
    throw DataError(fmt::format("a message of {} is at {} s, expected a time from 0 on: MCAP has no times before 1970",
                                state.topic, format_seconds(time)));
  }
  const auto ns = static_cast<std::uint64_t>(time.ns);
  state.index.push_back({ns, chunk_.size()});
  append_mcap_begin(chunk_, kWriteMessage, 2 + 4 + 8 + 8 + message.size());
  append_value(chunk_, channel);
  append_value(chunk_, static_cast<std::uint32_t>(state.messages));
  append_value(chunk_, ns);  // recorded
  append_value(chunk_, ns);  // published
  chunk_ += message;
  ++state.messages;
  ++messages_;
  chunk_times_.add(ns);
  times_.add(ns);
  if (chunk_.size() >= settings_.chunk_bytes) {
    close_chunk();
  }
}

void McapWriter::close_chunk() {
  if (chunk_.empty()) {
    return;
  }
  const bool compress = settings_.zstd_level != 0;
  const std::string compression = compress ? "zstd" : "";
  const std::string records = compress ? mcap_compressed(chunk_, settings_.zstd_level) : chunk_;
  std::string content;
  content.reserve(8 + 8 + 8 + 4 + 4 + compression.size() + 8);
  append_value(content, chunk_times_.first);
  append_value(content, chunk_times_.last);
  append_value(content, static_cast<std::uint64_t>(chunk_.size()));
  append_value(content, crc32(chunk_));
  append_mcap_bytes(content, compression);
  append_value(content, static_cast<std::uint64_t>(records.size()));
  const std::uint64_t chunk_start = position_;
  std::string begin;
  append_mcap_begin(begin, kWriteChunk, content.size() + records.size());
  put(begin + content);
  put(records);
  const std::uint64_t index_start = position_;

  std::string offsets;  // of the indexes of channels
  std::string indexes;
  for (std::size_t channel = 0; channel < channels_.size(); ++channel) {
    std::vector<IndexEntry>& entries = channels_[channel].index;
    if (entries.empty()) {
      continue;
    }
    std::stable_sort(entries.begin(), entries.end(),
                     [](const IndexEntry& a, const IndexEntry& b) { return a.time < b.time; });
    std::string pairs;
    for (const IndexEntry& entry : entries) {
      append_value(pairs, entry.time);
      append_value(pairs, entry.offset);
    }
    entries.clear();
    append_value(offsets, static_cast<std::uint16_t>(channel));
    append_value(offsets, static_cast<std::uint64_t>(index_start + indexes.size()));
    std::string index;
    append_value(index, static_cast<std::uint16_t>(channel));
    append_mcap_bytes(index, pairs);
    indexes += mcap_record_bytes(kWriteMessageIndex, index);
  }
  put(indexes);

  std::string entry;
  append_value(entry, chunk_times_.first);
  append_value(entry, chunk_times_.last);
  append_value(entry, chunk_start);
  append_value(entry, index_start - chunk_start);
  append_mcap_bytes(entry, offsets);
  append_value(entry, static_cast<std::uint64_t>(indexes.size()));
  append_mcap_bytes(entry, compression);
  append_value(entry, static_cast<std::uint64_t>(records.size()));
  append_value(entry, static_cast<std::uint64_t>(chunk_.size()));
  chunk_indexes_ += mcap_record_bytes(kWriteChunkIndex, entry);
  ++chunks_;
  chunk_.clear();
  chunk_times_ = {};
}

void McapWriter::add_metadata(const std::string& name, const std::map<std::string, std::string>& metadata) {
  std::string content;
  append_mcap_bytes(content, name);
  append_mcap_map(content, metadata);
  const std::string record = mcap_record_bytes(kWriteMetadata, content);
  std::string index;
  append_value(index, position_);
  append_value(index, static_cast<std::uint64_t>(record.size()));
  append_mcap_bytes(index, name);
  metadata_indexes_ += mcap_record_bytes(kWriteMetadataIndex, index);
  ++metadata_;
  put(record);
}

std::string McapWriter::statistics() const {
  std::string content;
  append_value(content, messages_);
  append_value(content, static_cast<std::uint16_t>(schemas_.size()));
  append_value(content, static_cast<std::uint32_t>(channels_.size()));
  append_value(content, std::uint32_t{0});  // attachments
  append_value(content, metadata_);
  append_value(content, chunks_);
  append_value(content, times_.first);
  append_value(content, times_.last);
  std::string counts;
  for (std::size_t channel = 0; channel < channels_.size(); ++channel) {
    append_value(counts, static_cast<std::uint16_t>(channel));
    append_value(counts, channels_[channel].messages);
  }
  append_mcap_bytes(content, counts);
  return mcap_record_bytes(kWriteStatistics, content);
}

void McapWriter::finish() {
  close_chunk();
  std::string data_end;
  append_value(data_end, data_crc_);  // of all bytes before this record
  put(mcap_record_bytes(kWriteDataEnd, data_end));

  const std::uint64_t summary_start = position_;
  std::string schemas;
  for (const std::string& record : schemas_) {
    schemas += record;
  }
  std::string channels;
  for (const ChannelState& channel : channels_) {
    channels += channel.record;
  }
  const Group groups[] = {{kWriteSchema, std::move(schemas)},
                          {kWriteChannel, std::move(channels)},
                          {kWriteStatistics, statistics()},
                          {kWriteMetadataIndex, std::move(metadata_indexes_)},
                          {kWriteChunkIndex, std::move(chunk_indexes_)}};
  std::string summary;
  std::string offsets;
  for (const Group& group : groups) {
    if (group.records.empty()) {
      continue;
    }
    std::string offset;
    append_value(offset, group.opcode);
    append_value(offset, summary_start + summary.size());
    append_value(offset, static_cast<std::uint64_t>(group.records.size()));
    offsets += mcap_record_bytes(kWriteSummaryOffset, offset);
    summary += group.records;
  }
  const std::uint64_t offsets_start = summary_start + summary.size();
  summary += offsets;
  // The checksum takes in the footer up to itself.
  append_mcap_begin(summary, kWriteFooter, 8 + 8 + 4);
  append_value(summary, summary_start);
  append_value(summary, offsets_start);
  append_value(summary, crc32(summary));
  put(summary);
  put(kWriterMagic);
}

}  // namespace dynamic_icp::bags
