// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/recording/bags/byte_source.hpp"
#include "dynamic_icp/recording/bags/chunk_cache.hpp"
#include "dynamic_icp/recording/bags/compression.hpp"
#include "dynamic_icp/recording/bags/file_bag.hpp"
#include "dynamic_icp/recording/bags/ros1_records.hpp"
#include "dynamic_icp/recording/formats/memory_error.hpp"

namespace dynamic_icp::bags {
namespace {

/// A chunk as the end of the file describes it.
struct Ros1Chunk {
  std::uint64_t at = 0;
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> counts;  ///< connections and their messages
};

/// The begin of a chunk as it is.
struct Ros1ChunkHeader {
  Ros1Record record;
  Compression compression = Compression::kNone;
  std::uint32_t size = 0;  ///< unpacked
};

class Ros1Bag final : public FileBag {
 public:
  Ros1Bag(const std::filesystem::path& path, const std::filesystem::path& name)
      : FileBag("rosbag", name), file_(path, name) {
    open();
  }

  [[nodiscard]] std::optional<TimeSpan> span() const override { return span_; }

  [[nodiscard]] std::vector<MessageEntry> messages(std::span<const std::size_t> wanted) const override {
    const std::vector<bool> is_wanted = chosen(wanted, topics_.size());
    std::vector<MessageEntry> entries = of_topics(seen_, is_wanted);
    FileBytes source(file_, FileBytes::kOneRecord);
    for (const Ros1Chunk& chunk : chunks_) {
      if (std::any_of(chunk.counts.begin(), chunk.counts.end(),
                      [&](const auto& count) { return is_wanted[topic_of_.at(count.first)]; })) {
        append_entries(source, chunk, is_wanted, entries);
      }
    }
    sort_by_time(entries);
    return entries;
  }

  [[nodiscard]] std::string read(const MessageEntry& entry) const override { return read_front(entry, kMaxPieceBytes); }

  [[nodiscard]] std::string read_front(const MessageEntry& entry, std::size_t bytes) const override {
    FileBytes source(file_, FileBytes::kOneRecord);
    const Ros1Record outer = ros1_record(source, entry.place);
    if (outer.op != Ros1Op::kChunk) {  // a message outside of any chunk
      check_message(source, outer, entry);
      return file_.read(outer.data_at, std::min<std::uint64_t>(outer.data_size, bytes));
    }
    const Ros1ChunkHeader chunk = chunk_header(source, outer);
    if (chunk.compression == Compression::kNone) {
      const Ros1Record message = ros1_record(source, outer.data_at + entry.offset);
      check_message(source, message, entry);
      if (message.end() > outer.end()) {
        throw source.damage(message.at, "a message that goes beyond its chunk");
      }
      return file_.read(message.data_at, std::min<std::uint64_t>(message.data_size, bytes));
    }
    const ChunkCache::Content content = cache_.get(entry.place, [&] { return unpacked(chunk); });
    ChunkBytes inner(*content, file_, entry.place);
    const Ros1Record message = ros1_record(inner, entry.offset);
    check_message(inner, message, entry);
    return std::string(inner.bytes(message.data_at, message.data_size).substr(0, bytes));
  }

 private:
  void open() {
    FileBytes source(file_);
    if (source.bytes(0, kRos1Magic.size()) != kRos1Magic) {
      throw source.damage(0, "expected '#ROSBAG V2.0'");
    }
    std::string reason;
    try {
      const Ros1Record header = ros1_record(source, kRos1Magic.size());
      if (header.op != Ros1Op::kBagHeader) {
        throw source.damage(header.at, "expected the header of the bag");
      }
      if (const auto encryptor = ros1_field(header.header, "encryptor"); encryptor && !encryptor->empty()) {
        throw DataError(fmt::format("{}: is encrypted; decrypt it with 'rosbag decrypt' first", path().string()));
      }
      const auto index_at = ros1_number<std::uint64_t>(source, header, "index_pos");
      if (index_at == 0) {
        reason = "the recording was not closed";
      } else {
        read_index(source, header, index_at);
        return;
      }
    } catch (const Damage& damage) {
      reason = fmt::format("damaged at byte {}: {}", damage.byte(), damage.reason());
    }
    chunks_.clear();
    channels_.clear();
    span_.reset();
    notes_.push_back(fmt::format("{}: no index ({}): all of it is looked through", path().string(), reason));
    scan(source);
  }

  void read_index(FileBytes& source, const Ros1Record& header, std::uint64_t index_at) {
    const auto connections = ros1_number<std::uint32_t>(source, header, "conn_count");
    const auto chunks = ros1_number<std::uint32_t>(source, header, "chunk_count");
    std::uint64_t at = index_at;
    for (std::uint32_t k = 0; k < connections; ++k) {
      at = add_connection(source, expect(source, at, Ros1Op::kConnection, "a connection of the index"));
    }
    for (std::uint32_t k = 0; k < chunks; ++k) {
      const Ros1Record info = expect(source, at, Ros1Op::kChunkInfo, "a chunk of the index");
      add_chunk(source, info, index_at);
      at = info.end();
    }
    sort_topics();
  }

  static Ros1Record expect(ByteSource& source, std::uint64_t at, Ros1Op op, const char* what) {
    Ros1Record record = ros1_record(source, at);
    if (record.op != op) {
      throw source.damage(at, fmt::format("expected {}", what));
    }
    return record;
  }

  std::uint64_t add_connection(ByteSource& source, const Ros1Record& record) {
    channels_.try_emplace(ros1_number<std::uint32_t>(source, record, "conn"), ros1_topic(source, record));
    return record.end();
  }

  void add_chunk(FileBytes& source, const Ros1Record& info, std::uint64_t index_at) {
    Ros1Chunk chunk;
    chunk.at = ros1_number<std::uint64_t>(source, info, "chunk_pos");
    const auto connections = ros1_number<std::uint32_t>(source, info, "count");
    if (chunk.at >= index_at || info.data_size != std::uint64_t{8} * connections) {
      throw source.damage(info.at, "a chunk of the index whose place or length cannot be");
    }
    ByteReader data(source.bytes(info.data_at, info.data_size), source, info.data_at);
    while (!data.is_done()) {
      const auto connection = data.number<std::uint32_t>();
      const auto count = data.number<std::uint32_t>();
      const auto channel = channels_.find(connection);
      if (channel == channels_.end()) {
        throw source.damage(info.at, fmt::format("a chunk of connection {}, which does not exist", connection));
      }
      channel->second.messages += count;
      if (count > 0) {
        chunk.counts.emplace_back(connection, count);
      }
    }
    if (!chunk.counts.empty()) {
      chunk.first_ns = ros1_time(ros1_number<std::uint64_t>(source, info, "start_time"));
      chunk.last_ns = ros1_time(ros1_number<std::uint64_t>(source, info, "end_time"));
      see(chunk.first_ns);
      see(chunk.last_ns);
    }
    chunks_.push_back(std::move(chunk));
  }

  void see(std::int64_t time) {
    span_ = span_ ? TimeSpan{std::min(span_->first_ns, time), std::max(span_->last_ns, time)} : TimeSpan{time, time};
  }

  /// Channels become topics, and the numbers of channels in `seen_` those of topics.
  void sort_topics() {
    TopicTable table = table_of(channels_);
    topics_ = std::move(table.topics);
    topic_of_ = std::move(table.topic_of);
    channels_.clear();
  }

  /// Looks through all records up to the damage.
  void scan(FileBytes& source) {
    std::uint64_t at = kRos1Magic.size();
    try {
      while (at < file_.size()) {
        const Ros1Record record = ros1_record(source, at);
        if (record.op == Ros1Op::kChunk) {
          scan_chunk(source, chunk_header(source, record));
        } else if (record.op == Ros1Op::kMessage || record.op == Ros1Op::kConnection) {
          // Of the chunk that was being written when the recording ended.
          scan_record(source, record, at, 0);
        } else if (record.op < Ros1Op::kMessage || record.op > Ros1Op::kConnection) {
          throw source.damage(at, "expected a record of a ROS 1 bag");
        }
        if (record.end() > file_.size()) {
          throw source.damage(at, fmt::format("a record of {} bytes, of which {} are there", record.data_size,
                                              file_.size() - record.data_at));
        }
        at = record.end();
      }
    } catch (const Damage& damage) {
      if (seen_.empty()) {
        throw;
      }
      notes_.push_back(fmt::format("{}: damaged from byte {} on ({}): the {} messages before it are left",
                                   path().string(), damage.byte(), damage.reason(), seen_.size()));
    }
    sort_topics();
    for (MessageEntry& entry : seen_) {
      see(entry.recorded_ns);
      entry.topic = topic_of_.at(entry.topic);
    }
  }

  void scan_chunk(FileBytes& source, const Ros1ChunkHeader& chunk) {
    const Ros1Record& record = chunk.record;
    if (chunk.compression == Compression::kNone) {
      const std::uint64_t end = std::min(record.end(), file_.size());
      for (std::uint64_t at = record.data_at; at < end;) {
        const Ros1Record inner = ros1_record(source, at);
        scan_record(source, inner, record.at, at - record.data_at);
        at = inner.end();
        if (at > record.end()) {
          throw source.damage(inner.at, "a record that goes beyond its chunk");
        }
      }
      return;
    }
    const ChunkCache::Content content = cache_.get(record.at, [&] { return unpacked(chunk); });
    ChunkBytes inner(*content, file_, record.at);
    for (std::uint64_t at = 0; at < inner.size();) {
      const Ros1Record message = ros1_record(inner, at);
      scan_record(inner, message, record.at, at);
      at = message.end();
    }
  }

  /// A record within a chunk, or of one that is no chunk yet.
  void scan_record(ByteSource& source, const Ros1Record& record, std::uint64_t place, std::uint64_t offset) {
    if (record.end() > source.size()) {
      throw source.damage(record.at, fmt::format("a record of {} bytes, of which {} are there", record.data_size,
                                                 source.size() - record.data_at));
    }
    if (record.op == Ros1Op::kConnection) {
      add_connection(source, record);
    } else if (record.op == Ros1Op::kMessage) {
      const auto connection = ros1_number<std::uint32_t>(source, record, "conn");
      const auto channel = channels_.find(connection);
      if (channel == channels_.end()) {
        throw source.damage(record.at, fmt::format("a message of connection {}, which does not exist", connection));
      }
      const std::int64_t time = ros1_time(ros1_number<std::uint64_t>(source, record, "time"));
      ++channel->second.messages;
      seen_.push_back({time, place, static_cast<std::uint32_t>(offset), connection, 0});
    } else {
      throw source.damage(record.at, "expected a message or a connection");
    }
  }

  Ros1ChunkHeader chunk_header(ByteSource& source, const Ros1Record& record) const {
    Ros1ChunkHeader chunk{record, Compression::kNone, ros1_number<std::uint32_t>(source, record, "size")};
    const std::string_view name = ros1_field(record.header, "compression").value_or("none");
    const std::optional<Compression> compression = compression_of(name);
    if (!compression || *compression == Compression::kZstd) {
      throw source.damage(record.at, fmt::format("a chunk whose compression is neither none, bz2 nor lz4"));
    }
    chunk.compression = *compression;
    return chunk;
  }

  /// The content of a packed chunk; of one that the end of the file cuts, what is there.
  [[nodiscard]] std::string unpacked(const Ros1ChunkHeader& chunk) const {
    const Ros1Record& record = chunk.record;
    if (chunk.size > kMaxPieceBytes) {
      throw Damage(path(), record.at,
                   fmt::format("a chunk of {} bytes, expected at most {}", chunk.size, kMaxPieceBytes));
    }
    const std::uint64_t left = file_.size() - record.data_at;
    const bool is_cut = record.data_size > left;
    Unpacked content = formats::with_memory_for(path(), [&] {
      return unpack(chunk.compression, file_.read(record.data_at, std::min(record.data_size, left)), chunk.size);
    });
    if (!content.fault.empty() && !(is_cut && content.is_cut)) {
      throw Damage(path(), record.at, "chunk: " + content.fault);
    }
    return std::move(content.bytes);
  }

  /// By the index records that follow the chunk; where they are damaged by the chunk itself.
  void append_entries(FileBytes& source, const Ros1Chunk& chunk, const std::vector<bool>& is_wanted,
                      std::vector<MessageEntry>& entries) const {
    const std::size_t before = entries.size();
    const Ros1ChunkHeader header = chunk_header(source, expect(source, chunk.at, Ros1Op::kChunk, "a chunk"));
    try {
      append_index(source, chunk, header, is_wanted, entries);
    } catch (const Damage&) {
      entries.resize(before);
      append_content(chunk, header, is_wanted, entries);
    }
  }

  void append_index(FileBytes& source, const Ros1Chunk& chunk, const Ros1ChunkHeader& header,
                    const std::vector<bool>& is_wanted, std::vector<MessageEntry>& entries) const {
    std::map<std::uint32_t, std::uint32_t> missing(chunk.counts.begin(), chunk.counts.end());
    std::uint64_t at = header.record.end();
    while (!missing.empty()) {
      const Ros1Record index = expect(source, at, Ros1Op::kIndexData, "the index of a chunk");
      const auto connection = ros1_number<std::uint32_t>(source, index, "conn");
      const auto count = ros1_number<std::uint32_t>(source, index, "count");
      const auto stated = missing.find(connection);
      if (stated == missing.end() || stated->second != count || index.data_size != std::uint64_t{12} * count ||
          ros1_number<std::uint32_t>(source, index, "ver") != 1) {
        throw source.damage(at, "the index of a chunk does not fit it");
      }
      const std::uint32_t topic = topic_of_.at(connection);
      if (is_wanted[topic]) {
        ByteReader data(source.bytes(index.data_at, index.data_size), source, index.data_at);
        while (!data.is_done()) {
          const std::int64_t time = ros1_time(data.number<std::uint64_t>());
          const auto offset = data.number<std::uint32_t>();
          if (offset >= header.size || time < chunk.first_ns || time > chunk.last_ns) {
            throw source.damage(at, "the index of a chunk names a place or a time beyond it");
          }
          entries.push_back({time, chunk.at, offset, topic, 0});
        }
      }
      missing.erase(stated);
      at = index.end();
    }
  }

  void append_content(const Ros1Chunk& chunk, const Ros1ChunkHeader& header, const std::vector<bool>& is_wanted,
                      std::vector<MessageEntry>& entries) const {
    const auto content = cache_.get(chunk.at, [&] { return unpacked(header); });
    ChunkBytes inner(*content, file_, chunk.at);
    for (std::uint64_t at = 0; at < inner.size();) {
      const Ros1Record record = ros1_record(inner, at);
      if (record.op == Ros1Op::kMessage) {
        const auto topic = topic_of_.find(ros1_number<std::uint32_t>(inner, record, "conn"));
        if (topic != topic_of_.end() && is_wanted[topic->second]) {
          entries.push_back({ros1_time(ros1_number<std::uint64_t>(inner, record, "time")), chunk.at,
                             static_cast<std::uint32_t>(at), topic->second, 0});
        }
      }
      at = record.end();
    }
  }

  void check_message(const ByteSource& source, const Ros1Record& record, const MessageEntry& entry) const {
    const auto topic = record.op == Ros1Op::kMessage
                           ? topic_of_.find(ros1_number<std::uint32_t>(source, record, "conn"))
                           : topic_of_.end();
    if (topic == topic_of_.end() || topic->second != entry.topic ||
        ros1_time(ros1_number<std::uint64_t>(source, record, "time")) != entry.recorded_ns) {
      throw source.damage(record.at, fmt::format("expected a message of {}, recorded at {} ns",
                                                 topics_[entry.topic].name, entry.recorded_ns));
    }
    if (record.data_size > kMaxPieceBytes) {
      throw source.damage(record.at,
                          fmt::format("a message of {} bytes, expected at most {}", record.data_size, kMaxPieceBytes));
    }
  }

  ReadableFile file_;
  std::vector<Ros1Chunk> chunks_;
  std::vector<MessageEntry> seen_;  // of a bag without index; while it is looked through their topics are connections
  std::map<std::uint64_t, Topic> channels_;  // by connection, until they are topics_
  std::map<std::uint64_t, std::uint32_t> topic_of_;
  std::optional<TimeSpan> span_;
  mutable ChunkCache cache_;
};

}  // namespace

std::unique_ptr<FileBag> open_ros1_bag(const std::filesystem::path& path, const std::filesystem::path& name) {
  return std::make_unique<Ros1Bag>(path, name);
}

}  // namespace dynamic_icp::bags
