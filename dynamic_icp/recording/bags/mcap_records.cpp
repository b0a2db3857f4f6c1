// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/bags/mcap_records.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "dynamic_icp/recording/bags/file_bag.hpp"

namespace dynamic_icp::bags {
namespace {

Encoding encoding_of(std::string_view name) {
  if (name == "ros1") {
    return Encoding::kRos1;
  }
  if (name == "cdr") {
    return Encoding::kCdr;
  }
  if (name == "protobuf") {
    return Encoding::kProtobuf;
  }
  return name == "json" ? Encoding::kJson : Encoding::kUnknown;
}

}  // namespace

McapRecord mcap_record(ByteSource& source, std::uint64_t at) {
  ByteReader head(source.bytes(at, McapRecord::kHeadBytes), source, at);
  McapRecord record;
  record.at = at;
  record.op = static_cast<McapOp>(head.number<std::uint8_t>());
  record.size = head.number<std::uint64_t>();
  record.content_at = at + McapRecord::kHeadBytes;
  if (record.op == McapOp{} || record.size > std::numeric_limits<std::uint64_t>::max() / 4) {
    throw source.damage(at, "expected a record of an MCAP file");
  }
  return record;
}

ByteReader mcap_content(ByteSource& source, const McapRecord& record) {
  if (record.size > kMaxPieceBytes) {
    throw source.damage(record.at,
                        fmt::format("a record of {} bytes, expected at most {}", record.size, kMaxPieceBytes));
  }
  return {source.bytes(record.content_at, record.size), source, record.content_at};
}

std::int64_t mcap_time(ByteReader& content) {
  const auto time = content.number<std::uint64_t>();
  if (time > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
    throw content.damage(fmt::format("a time of {} ns, which is after the year 2262", time));
  }
  return static_cast<std::int64_t>(time);
}

McapMessage mcap_message(ByteSource& source, const McapRecord& record) {
  if (record.content_at > source.size() || record.size > source.size() - record.content_at) {
    throw source.damage(record.at, fmt::format("a message of {} bytes, of which {} are there", record.size,
                                               source.size() - std::min(source.size(), record.content_at)));
  }
  if (record.size < McapMessage::kHeadBytes) {
    throw source.damage(
        record.at, fmt::format("a message of {} bytes, expected at least {}", record.size, McapMessage::kHeadBytes));
  }
  ByteReader head(source.bytes(record.content_at, McapMessage::kHeadBytes), source, record.content_at);
  McapMessage message;
  message.channel = head.number<std::uint16_t>();
  head.number<std::uint32_t>();  // sequence
  message.log_time_ns = mcap_time(head);
  message.data_at = record.content_at + McapMessage::kHeadBytes;
  message.data_size = record.size - McapMessage::kHeadBytes;
  return message;
}

McapChunkHeader mcap_chunk(ByteSource& source, const McapRecord& record) {
  constexpr std::uint64_t kFixedBytes = 8 + 8 + 8 + 4 + 4;
  constexpr std::uint32_t kMaxName = 64;
  ByteReader fixed(source.bytes(record.content_at, kFixedBytes), source, record.content_at);
  McapChunkHeader chunk;
  fixed.number<std::uint64_t>();  // first and last time: the messages say them
  fixed.number<std::uint64_t>();
  chunk.size = fixed.number<std::uint64_t>();
  chunk.crc = fixed.number<std::uint32_t>();
  const auto name_size = fixed.number<std::uint32_t>();
  if (name_size > kMaxName) {
    throw source.damage(record.at, "a chunk whose compression has no sensible name");
  }
  const std::uint64_t rest = record.content_at + kFixedBytes;
  ByteReader name(source.bytes(rest, name_size + std::uint64_t{8}), source, rest);
  chunk.compression = name.take(name_size);
  chunk.data_size = name.number<std::uint64_t>();
  chunk.data_at = name.place();
  if (chunk.data_at > record.end() || chunk.data_size > record.end() - chunk.data_at) {
    throw source.damage(record.at,
                        fmt::format("a chunk of {} bytes that holds {} packed bytes", record.size, chunk.data_size));
  }
  return chunk;
}

McapChunkIndex mcap_chunk_index(ByteSource& source, const McapRecord& record) {
  ByteReader content = mcap_content(source, record);
  McapChunkIndex index;
  index.first_ns = mcap_time(content);
  index.last_ns = mcap_time(content);
  index.at = content.number<std::uint64_t>();
  index.length = content.number<std::uint64_t>();
  const std::uint64_t begin = content.place() + 4;
  const std::string_view indices = content.text();
  for (ByteReader pairs(indices, source, begin); !pairs.is_done();) {
    const auto channel = pairs.number<std::uint16_t>();
    index.indices.emplace_back(channel, pairs.number<std::uint64_t>());
  }
  index.index_length = content.number<std::uint64_t>();
  content.text();                   // compression: the chunk says it
  content.number<std::uint64_t>();  // packed size
  index.size = content.number<std::uint64_t>();
  return index;
}

void McapChannels::add_schema(ByteReader content) {
  const auto id = content.number<std::uint16_t>();
  std::string type = plain_type(content.text());
  content.text();  // encoding of the schema: that of the messages tells enough
  const std::string_view data = content.text();
  if (!schemas_.contains(id)) {
    keep(content, type.size() + data.size());
    schemas_.emplace(id, Schema{std::move(type), std::string(data)});
  }
}

void McapChannels::add_channel(ByteReader content) {
  const auto id = content.number<std::uint16_t>();
  const auto schema = content.number<std::uint16_t>();
  if (channels_.contains(id)) {
    return;
  }
  Topic topic;
  topic.name = content.text();
  topic.encoding_name = content.text();
  topic.encoding = encoding_of(topic.encoding_name);
  if (schema != 0) {  // 0: there is none
    const auto found = schemas_.find(schema);
    if (found == schemas_.end()) {
      throw content.damage(fmt::format("a channel of schema {}, which does not exist", schema));
    }
    keep(content, found->second.type.size() + found->second.data.size());
    topic.type = found->second.type;
    topic.schema = found->second.data;
  }
  keep(content, topic.name.size() + topic.encoding_name.size());
  channels_.emplace(id, std::move(topic));
}

void McapChannels::keep(const ByteReader& content, std::uint64_t bytes) {
  kept_ += bytes;
  if (kept_ > kMaxBytes) {
    throw content.damage(
        fmt::format("the names and descriptions of its topics have more than {} MiB", kMaxBytes >> 20U));
  }
}

}  // namespace dynamic_icp::bags
