// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/bags/mcap_pieces.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/recording/bags/compression.hpp"
#include "dynamic_icp/recording/bags/crc32.hpp"
#include "dynamic_icp/recording/formats/memory_error.hpp"

namespace dynamic_icp::bags {
namespace {

/// The content of a chunk; of one that the end of the file cuts, what is there.
std::string unpacked(const ReadableBytes& file, const McapRecord& record) {
  FileBytes source(file, FileBytes::kOneRecord);
  const McapChunkHeader chunk = mcap_chunk(source, record);
  const std::optional<Compression> compression = compression_of(chunk.compression);
  if (!compression) {
    throw source.damage(record.at, "a chunk whose compression is neither none, lz4 nor zstd");
  }
  if (chunk.size > kMaxPieceBytes || chunk.data_size > kMaxPieceBytes) {
    throw source.damage(record.at, fmt::format("a chunk of {} bytes, expected at most {}",
                                               std::max(chunk.size, chunk.data_size), kMaxPieceBytes));
  }
  const std::uint64_t left = source.size() - chunk.data_at;
  const bool is_cut = chunk.data_size > left;
  Unpacked content = formats::with_memory_for(file.path(), [&] {
    return unpack(*compression, file.read(chunk.data_at, std::min(chunk.data_size, left)), chunk.size);
  });
  if (is_cut && content.is_cut) {
    return std::move(content.bytes);
  }
  if (!content.fault.empty()) {
    throw source.damage(record.at, "chunk: " + content.fault);
  }
  if (chunk.crc != 0 && chunk.crc != crc32(content.bytes)) {
    throw source.damage(record.at, "the chunk does not have the checksum that is stored of it");
  }
  return std::move(content.bytes);
}

McapMessage checked_message(ByteSource& source, const McapRecord& record, const MessageEntry& entry,
                            const std::map<std::uint64_t, std::uint32_t>& topic_of, const std::string& name) {
  if (record.op == McapOp::kMessage) {
    const McapMessage message = mcap_message(source, record);
    if (message.data_size > kMaxPieceBytes) {
      throw source.damage(record.at,
                          fmt::format("a message of {} bytes, expected at most {}", message.data_size, kMaxPieceBytes));
    }
    const auto topic = topic_of.find(message.channel);
    if (topic != topic_of.end() && topic->second == entry.topic && message.log_time_ns == entry.recorded_ns) {
      return message;
    }
  }
  throw source.damage(record.at, fmt::format("expected a message of {}, recorded at {} ns", name, entry.recorded_ns));
}

}  // namespace

ChunkCache::Content McapPieces::chunk(const McapRecord& record) const {
  if (record.op != McapOp::kChunk) {
    throw Damage(file_->path(), record.at, "expected a chunk");
  }
  return cache_.get(record.at, [&] { return unpacked(*file_, record); });
}

std::string McapPieces::cut_chunk(const McapRecord& record) const { return unpacked(*file_, record); }

std::string McapPieces::message(const MessageEntry& entry, const std::map<std::uint64_t, std::uint32_t>& topic_of,
                                const std::string& name, std::size_t bytes) const {
  FileBytes source(*file_, FileBytes::kOneRecord);
  const McapRecord outer = mcap_record(source, entry.place);
  if (outer.op == McapOp::kMessage) {  // outside of any chunk
    const McapMessage message = checked_message(source, outer, entry, topic_of, name);
    return file_->read(message.data_at, std::min<std::uint64_t>(message.data_size, bytes));
  }
  const ChunkCache::Content content = chunk(outer);
  ChunkBytes inner(*content, *file_, entry.place);
  const McapMessage message = checked_message(inner, mcap_record(inner, entry.offset), entry, topic_of, name);
  return std::string(inner.bytes(message.data_at, message.data_size).substr(0, bytes));
}

}  // namespace dynamic_icp::bags
