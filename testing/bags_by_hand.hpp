// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include "testing/npz_by_hand.hpp"

// For tests: bags put together by the published formats, without the code under test.
namespace dynamic_icp::by_hand {

/// Bytes packed by "none", "bz2", "lz4" or "zstd".
inline std::string packed(const std::string& compression, const std::string& bytes) {
  if (compression == "bz2") {
    std::string out(bytes.size() + bytes.size() / 50 + 1000, '\0');
    auto size = static_cast<unsigned>(out.size());
    BZ2_bzBuffToBuffCompress(out.data(), &size, const_cast<char*>(bytes.data()), static_cast<unsigned>(bytes.size()), 9,
                             0, 0);
    return out.substr(0, size);
  }
  if (compression == "lz4") {
    std::string out(LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
    return out.substr(0, LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
  }
  if (compression == "zstd") {
    std::string out(ZSTD_compressBound(bytes.size()), '\0');
    return out.substr(0, ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1));
  }
  return bytes;
}

template <class Number>
std::string number(Number value) {
  std::string bytes(sizeof(Number), '\0');
  std::memcpy(bytes.data(), &value, sizeof(Number));
  return bytes;
}

/// A text behind its length.
inline std::string text(const std::string& content) {
  return number(static_cast<std::uint32_t>(content.size())) + content;
}

struct Channel {
  std::uint16_t id = 0;
  std::string topic;
  std::string type;
  std::string definition;
  std::string encoding = "cdr";  ///< MCAP only
};

struct Message {
  std::uint16_t channel = 0;
  std::int64_t time_ns = 0;
  std::string data;
};

struct Layout {
  std::string compression = "none";
  std::size_t chunk_messages = 2;
  bool has_index = true;
  // MCAP only.
  bool is_chunked = true;
  bool has_crc = true;
  bool has_message_index = true;
  bool has_statistics = true;
  bool repeats_channels = true;
};

// ROS 1 bags, format 2.0 (wiki.ros.org/Bags/Format/2.0).

inline std::string ros1_field(const std::string& name, const std::string& value) { return text(name + "=" + value); }

inline std::string ros1_record(char op, const std::string& fields, const std::string& data) {
  return text(fields + ros1_field("op", std::string(1, op))) + text(data);
}

inline std::string ros1_time(std::int64_t ns) {
  return number(static_cast<std::uint32_t>(ns / 1'000'000'000)) +
         number(static_cast<std::uint32_t>(ns % 1'000'000'000));
}

inline std::string ros1_connection(const Channel& channel) {
  return ros1_record('\x07', ros1_field("conn", number(std::uint32_t{channel.id})) + ros1_field("topic", channel.topic),
                     ros1_field("topic", channel.topic) + ros1_field("type", channel.type) +
                         ros1_field("md5sum", "0123456789abcdef0123456789abcdef") +
                         ros1_field("message_definition", channel.definition));
}

inline std::string ros1_message(const Message& message) {
  return ros1_record(
      '\x02',
      ros1_field("conn", number(std::uint32_t{message.channel})) + ros1_field("time", ros1_time(message.time_ns)),
      message.data);
}

inline std::string ros1_bag_header(std::uint64_t index_pos, std::size_t connections, std::size_t chunks) {
  const std::string fields = ros1_field("index_pos", number(index_pos)) +
                             ros1_field("conn_count", number(static_cast<std::uint32_t>(connections))) +
                             ros1_field("chunk_count", number(static_cast<std::uint32_t>(chunks)));
  const std::size_t used = ros1_record('\x03', fields, "").size();
  return ros1_record('\x03', fields, std::string(4096 - used, ' '));
}

inline std::string ros1_chunk(const std::string& compression, const std::string& content) {
  return ros1_record(
      '\x05',
      ros1_field("compression", compression) + ros1_field("size", number(static_cast<std::uint32_t>(content.size()))),
      packed(compression, content));
}

/// Without index as a recorder leaves it that was ended between two chunks.
inline std::string ros1_bag(const std::vector<Channel>& channels, const std::vector<Message>& messages,
                            const Layout& layout = {}) {
  const std::string magic = "#ROSBAG V2.0\n";
  std::string chunks;
  std::string infos;
  std::size_t chunk_count = 0;
  const std::size_t data_at = magic.size() + ros1_bag_header(0, 0, 0).size();
  for (std::size_t begin = 0; begin < messages.size(); begin += layout.chunk_messages) {
    const std::size_t chunk_at = data_at + chunks.size();
    std::string content;
    if (begin == 0) {
      for (const Channel& channel : channels) {
        content += ros1_connection(channel);
      }
    }
    std::map<std::uint32_t, std::string> indices;
    std::int64_t first = messages[begin].time_ns;
    std::int64_t last = first;
    for (std::size_t k = begin; k < std::min(begin + layout.chunk_messages, messages.size()); ++k) {
      indices[messages[k].channel] +=
          ros1_time(messages[k].time_ns) + number(static_cast<std::uint32_t>(content.size()));
      content += ros1_message(messages[k]);
      first = std::min(first, messages[k].time_ns);
      last = std::max(last, messages[k].time_ns);
    }
    chunks += ros1_chunk(layout.compression, content);
    std::string counts;
    for (const auto& [connection, index] : indices) {
      const auto count = static_cast<std::uint32_t>(index.size() / 12);
      chunks += ros1_record('\x04',
                            ros1_field("ver", number(std::uint32_t{1})) + ros1_field("conn", number(connection)) +
                                ros1_field("count", number(count)),
                            index);
      counts += number(connection) + number(count);
    }
    infos += ros1_record('\x06',
                         ros1_field("ver", number(std::uint32_t{1})) +
                             ros1_field("chunk_pos", number(std::uint64_t{chunk_at})) +
                             ros1_field("start_time", ros1_time(first)) + ros1_field("end_time", ros1_time(last)) +
                             ros1_field("count", number(static_cast<std::uint32_t>(indices.size()))),
                         counts);
    ++chunk_count;
  }
  if (!layout.has_index) {
    return magic + ros1_bag_header(0, 0, 0) + chunks;
  }
  std::string connections;
  for (const Channel& channel : channels) {
    connections += ros1_connection(channel);
  }
  return magic + ros1_bag_header(data_at + chunks.size(), channels.size(), chunk_count) + chunks + connections + infos;
}

// MCAP (mcap.dev/spec).

inline std::string mcap_record(char op, const std::string& content) {
  return std::string(1, op) + number(std::uint64_t{content.size()}) + content;
}

inline std::string mcap_schema(const Channel& channel) {
  return mcap_record('\x03', number(static_cast<std::uint16_t>(channel.id + 1)) + text(channel.type) + text("ros2msg") +
                                 text(channel.definition));
}

inline std::string mcap_channel(const Channel& channel) {
  return mcap_record('\x04', number(channel.id) + number(static_cast<std::uint16_t>(channel.id + 1)) +
                                 text(channel.topic) + text(channel.encoding) + text(text("offered_qos") + text("x")));
}

inline std::string mcap_message(const Message& message) {
  return mcap_record('\x05', number(message.channel) + number(std::uint32_t{0}) + number(message.time_ns) +
                                 number(message.time_ns) + message.data);
}

inline std::string mcap_file(const std::vector<Channel>& channels, const std::vector<Message>& messages,
                             const Layout& layout = {}) {
  const std::string magic = "\x89MCAP0\r\n";
  std::string file = magic + mcap_record('\x01', text("ros2") + text("by hand"));
  std::string definitions;
  for (const Channel& channel : channels) {
    definitions += mcap_schema(channel) + mcap_channel(channel);
  }
  std::string chunk_indices;
  std::uint32_t chunk_count = 0;
  std::map<std::uint16_t, std::uint64_t> counts;
  std::int64_t first_time = messages.empty() ? 0 : messages.front().time_ns;
  std::int64_t last_time = first_time;
  for (const Message& message : messages) {
    ++counts[message.channel];
    first_time = std::min(first_time, message.time_ns);
    last_time = std::max(last_time, message.time_ns);
  }
  if (!layout.is_chunked) {
    file += definitions;
    for (const Message& message : messages) {
      file += mcap_message(message);
    }
  }
  for (std::size_t begin = 0; layout.is_chunked && begin < messages.size(); begin += layout.chunk_messages) {
    std::string content = begin == 0 ? definitions : std::string();
    std::map<std::uint16_t, std::string> indices;
    std::int64_t first = messages[begin].time_ns;
    std::int64_t last = first;
    for (std::size_t k = begin; k < std::min(begin + layout.chunk_messages, messages.size()); ++k) {
      indices[messages[k].channel] += number(messages[k].time_ns) + number(std::uint64_t{content.size()});
      content += mcap_message(messages[k]);
      first = std::min(first, messages[k].time_ns);
      last = std::max(last, messages[k].time_ns);
    }
    const std::string compression = layout.compression == "none" ? "" : layout.compression;
    const std::string data = packed(layout.compression, content);
    const std::size_t chunk_at = file.size();
    file += mcap_record('\x06', number(first) + number(last) + number(std::uint64_t{content.size()}) +
                                    number(layout.has_crc ? formats::crc32_of(content) : 0U) + text(compression) +
                                    number(std::uint64_t{data.size()}) + data);
    const std::size_t chunk_end = file.size();
    std::string offsets;
    for (const auto& [channel, index] : indices) {
      if (layout.has_message_index) {
        offsets += number(channel) + number(std::uint64_t{file.size()});
        file += mcap_record('\x07', number(channel) + text(index));
      }
    }
    chunk_indices +=
        mcap_record('\x08', number(first) + number(last) + number(std::uint64_t{chunk_at}) +
                                number(std::uint64_t{chunk_end - chunk_at}) + text(offsets) +
                                number(std::uint64_t{file.size() - chunk_end}) + text(compression) +
                                number(std::uint64_t{data.size()}) + number(std::uint64_t{content.size()}));
    ++chunk_count;
  }
  file += mcap_record('\x0F', number(std::uint32_t{0}));
  std::string summary;
  const std::size_t summary_at = file.size();
  if (layout.has_index) {
    summary += layout.repeats_channels ? definitions : std::string();
    if (layout.has_statistics) {
      std::string by_channel;
      for (const auto& [channel, count] : counts) {
        by_channel += number(channel) + number(count);
      }
      const auto channel_count = static_cast<std::uint32_t>(channels.size());
      summary += mcap_record('\x0B', number(std::uint64_t{messages.size()}) +
                                         number(static_cast<std::uint16_t>(channel_count)) + number(channel_count) +
                                         number(std::uint32_t{0}) + number(std::uint32_t{0}) + number(chunk_count) +
                                         number(first_time) + number(last_time) + text(by_channel));
    }
    summary += chunk_indices;
  }
  summary += std::string(1, '\x02') + number(std::uint64_t{20}) +
             number(std::uint64_t{layout.has_index ? summary_at : 0}) + number(std::uint64_t{0});
  return file + summary + number(layout.has_crc ? formats::crc32_of(summary) : 0U) + magic;
}

}  // namespace dynamic_icp::by_hand
