// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/recording/bags/byte_source.hpp"
#include "dynamic_icp/recording/bags/crc32.hpp"
#include "dynamic_icp/recording/bags/file_bag.hpp"
#include "dynamic_icp/recording/bags/mcap_pieces.hpp"
#include "dynamic_icp/recording/bags/mcap_records.hpp"
#include "dynamic_icp/recording/bags/mcap_scan.hpp"

namespace dynamic_icp::bags {
namespace {

/// Why an MCAP file is looked through although it is whole.
class NoMcapIndex : public DataError {
 public:
  using DataError::DataError;
};

class McapFile final : public FileBag {
 public:
  McapFile(const std::filesystem::path& path, const std::filesystem::path& name)
      : FileBag("mcap", name), pieces_(std::make_shared<ReadableFile>(path, name)), file_(pieces_.file()) {
    open();
  }

  [[nodiscard]] std::optional<TimeSpan> span() const override { return span_; }

  [[nodiscard]] std::vector<MessageEntry> messages(std::span<const std::size_t> wanted) const override {
    const std::vector<bool> is_wanted = chosen(wanted, topics_.size());
    std::vector<MessageEntry> entries = of_topics(seen_, is_wanted);
    FileBytes source(file_, FileBytes::kOneRecord);
    for (const McapChunkIndex& chunk : chunks_) {
      append_entries(source, chunk, is_wanted, entries);
    }
    sort_by_time(entries);
    return entries;
  }

  [[nodiscard]] std::string read(const MessageEntry& entry) const override { return read_front(entry, kMaxPieceBytes); }

  [[nodiscard]] std::string read_front(const MessageEntry& entry, std::size_t bytes) const override {
    return pieces_.message(entry, topic_of_, topics_[entry.topic].name, bytes);
  }

 private:
  static constexpr std::uint64_t kFooterBytes = 20;
  static constexpr std::uint64_t kTailBytes = McapRecord::kHeadBytes + kFooterBytes + kMcapMagic.size();

  void open() {
    FileBytes source(file_);
    if (source.bytes(0, kMcapMagic.size()) != kMcapMagic) {
      throw source.damage(0, "expected the mark of an MCAP file");
    }
    std::string reason;
    try {
      read_summary(source);
      return;
    } catch (const NoMcapIndex& none) {
      reason = none.what();
    } catch (const Damage& damage) {
      reason = fmt::format("damaged at byte {}: {}", damage.byte(), damage.reason());
    }
    chunks_.clear();
    span_.reset();
    notes_.push_back(fmt::format("{}: no index ({}): all of it is looked through", path().string(), reason));
    look_through();
  }

  void read_summary(FileBytes& source) {
    const std::uint64_t footer_at = file_.size() - std::min(file_.size(), kTailBytes);
    if (footer_at < kMcapMagic.size() ||
        source.bytes(file_.size() - kMcapMagic.size(), kMcapMagic.size()) != kMcapMagic) {
      throw source.damage(file_.size(), "the end is missing: the recording was not closed, or cut short");
    }
    const McapRecord footer = mcap_record(source, footer_at);
    if (footer.op != McapOp::kFooter || footer.size != kFooterBytes) {
      throw source.damage(footer_at, "expected the footer of an MCAP file");
    }
    ByteReader content = mcap_content(source, footer);
    const auto summary_at = content.number<std::uint64_t>();
    content.number<std::uint64_t>();  // where the offsets of the summary are
    const std::uint64_t crc_end = content.place();
    const auto crc = content.number<std::uint32_t>();
    if (summary_at == 0) {
      throw NoMcapIndex("it was written without");
    }
    if (summary_at > footer_at) {
      throw source.damage(footer_at, fmt::format("the summary cannot begin at byte {}", summary_at));
    }
    if (crc != 0 && crc != crc_of(source, summary_at, crc_end)) {
      throw source.damage(summary_at, "the summary does not have the checksum that is stored of it");
    }
    read_summary_records(source, summary_at, footer_at);
  }

  static std::uint32_t crc_of(FileBytes& source, std::uint64_t begin, std::uint64_t end) {
    std::uint32_t crc = 0;
    for (std::uint64_t at = begin; at < end;) {
      const std::uint64_t count = std::min<std::uint64_t>(end - at, FileBytes::kWindow);
      crc = crc32(source.bytes(at, count), crc);
      at += count;
    }
    return crc;
  }

  void read_summary_records(FileBytes& source, std::uint64_t begin, std::uint64_t end) {
    std::optional<std::map<std::uint16_t, std::uint64_t>> counts;
    std::uint64_t messages = 0;
    std::uint64_t chunks = 0;
    McapRecord record;
    for (std::uint64_t at = begin; at < end; at = record.end()) {
      record = mcap_record(source, at);
      if (record.op == McapOp::kSchema) {
        channels_.add_schema(mcap_content(source, record));
      } else if (record.op == McapOp::kChannel) {
        channels_.add_channel(mcap_content(source, record));
      } else if (record.op == McapOp::kChunkIndex) {
        chunks_.push_back(mcap_chunk_index(source, record));
        check_place(source, record, chunks_.back(), begin);
      } else if (record.op == McapOp::kStatistics) {
        ByteReader content = mcap_content(source, record);
        messages = content.number<std::uint64_t>();
        content.number<std::uint16_t>();  // schemas
        content.number<std::uint32_t>();  // channels
        content.number<std::uint32_t>();  // attachments
        content.number<std::uint32_t>();  // pieces of metadata
        chunks = content.number<std::uint32_t>();
        content.number<std::uint64_t>();  // first and last time
        content.number<std::uint64_t>();
        counts = counts_of(source, content);
      }
    }
    if (!counts) {
      throw NoMcapIndex("its summary has no statistics");
    }
    if (chunks != chunks_.size()) {
      throw NoMcapIndex(fmt::format("its summary names {} of {} chunks", chunks_.size(), chunks));
    }
    take_counts(*counts, messages);
    std::sort(chunks_.begin(), chunks_.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
    check_between_chunks(source, begin);
    TopicTable table = table_of(channels_.channels());
    topics_ = std::move(table.topics);
    topic_of_ = std::move(table.topic_of);
  }

  static void check_place(const ByteSource& source, const McapRecord& record, const McapChunkIndex& chunk,
                          std::uint64_t end) {
    if (chunk.at >= end || chunk.length > end - chunk.at || chunk.index_length > end - chunk.at - chunk.length) {
      throw source.damage(record.at, "the index of a chunk that goes beyond the data");
    }
  }

  static std::map<std::uint16_t, std::uint64_t> counts_of(const ByteSource& source, ByteReader& content) {
    std::map<std::uint16_t, std::uint64_t> counts;
    const std::uint64_t begin = content.place() + 4;
    for (ByteReader pairs(content.text(), source, begin); !pairs.is_done();) {
      const auto channel = pairs.number<std::uint16_t>();
      counts[channel] = pairs.number<std::uint64_t>();
    }
    return counts;
  }

  void take_counts(const std::map<std::uint16_t, std::uint64_t>& counts, std::uint64_t messages) {
    std::uint64_t sum = 0;
    for (const auto& [channel, count] : counts) {
      if (!channels_.has(channel)) {
        throw NoMcapIndex(fmt::format("its summary does not describe channel {}", channel));
      }
      channels_.count(channel, count);
      sum += count;
    }
    if (sum != messages) {
      throw NoMcapIndex("its summary does not count the messages of each channel");
    }
    for (const McapChunkIndex& chunk : chunks_) {
      for (const auto& [channel, at] : chunk.indices) {
        if (!channels_.has(channel)) {
          throw NoMcapIndex(fmt::format("its summary does not describe channel {}", channel));
        }
      }
      if (chunk.size > 0) {
        see(chunk.first_ns);
        see(chunk.last_ns);
      }
    }
    if (messages > 0 && chunks_.empty()) {
      throw NoMcapIndex("its messages are in no chunks");
    }
  }

  /// Messages outside of chunks are in no index.
  void check_between_chunks(FileBytes& source, std::uint64_t data_end) const {
    std::uint64_t at = kMcapMagic.size();
    const auto walk_to = [&](std::uint64_t end) {
      while (at < end) {
        const McapRecord record = mcap_record(source, at);
        if (record.op == McapOp::kMessage) {
          throw NoMcapIndex("some of its messages are in no chunks");
        }
        at = record.end();
      }
    };
    for (const McapChunkIndex& chunk : chunks_) {
      walk_to(chunk.at);
      at = chunk.at + chunk.length + chunk.index_length;
    }
    walk_to(data_end);
  }

  void see(std::int64_t time) {
    span_ = span_ ? TimeSpan{std::min(span_->first_ns, time), std::max(span_->last_ns, time)} : TimeSpan{time, time};
  }

  /// Looks through all records up to the damage.
  void look_through() {
    McapScan scan(pieces_);
    try {
      scan.advance();
      scan.take_cut();
    } catch (const Damage& damage) {
      seen_ = entries_of(scan.take_seen());
      if (seen_.empty()) {
        throw;
      }
      notes_.push_back(fmt::format("{}: damaged from byte {} on ({}): the {} messages before it are left",
                                   path().string(), damage.byte(), damage.reason(), seen_.size()));
    }
    if (seen_.empty()) {
      seen_ = entries_of(scan.take_seen());
    }
    TopicTable table = table_of(scan.channels().channels());
    topics_ = std::move(table.topics);
    topic_of_ = std::move(table.topic_of);
    for (MessageEntry& entry : seen_) {
      see(entry.recorded_ns);
      entry.topic = topic_of_.at(entry.topic);
    }
  }

  static std::vector<MessageEntry> entries_of(const std::vector<McapScan::Seen>& seen) {
    std::vector<MessageEntry> entries;
    entries.reserve(seen.size());
    for (const McapScan::Seen& one : seen) {
      entries.push_back(one.entry);
    }
    return entries;
  }

  /// By the message indices that follow the chunk; where there are none or they are damaged by the chunk itself.
  void append_entries(FileBytes& source, const McapChunkIndex& chunk, const std::vector<bool>& is_wanted,
                      std::vector<MessageEntry>& entries) const {
    const std::size_t before = entries.size();
    if (chunk.index_length > 0 || chunk.size == 0) {
      try {
        for (const auto& [channel, at] : chunk.indices) {
          if (const std::uint32_t topic = topic_of_.at(channel); is_wanted[topic]) {
            append_index(source, chunk, channel, at, topic, entries);
          }
        }
        return;
      } catch (const Damage&) {
        entries.resize(before);
      }
    }
    append_content(source, chunk, is_wanted, entries);
  }

  static void append_index(FileBytes& source, const McapChunkIndex& chunk, std::uint16_t channel, std::uint64_t at,
                           std::uint32_t topic, std::vector<MessageEntry>& entries) {
    const McapRecord record = mcap_record(source, at);
    if (record.op != McapOp::kMessageIndex) {
      throw source.damage(at, "expected the message index of a chunk");
    }
    ByteReader content = mcap_content(source, record);
    if (content.number<std::uint16_t>() != channel) {
      throw source.damage(at, "the message index of another channel");
    }
    const std::uint64_t begin = content.place() + 4;
    for (ByteReader pairs(content.text(), source, begin); !pairs.is_done();) {
      const std::int64_t time = mcap_time(pairs);
      const auto offset = pairs.number<std::uint64_t>();
      if (offset >= chunk.size || offset >= kMaxPieceBytes || time < chunk.first_ns || time > chunk.last_ns) {
        throw source.damage(at, "the message index of a chunk names a place or a time beyond it");
      }
      entries.push_back({time, chunk.at, static_cast<std::uint32_t>(offset), topic, 0});
    }
  }

  void append_content(FileBytes& source, const McapChunkIndex& chunk, const std::vector<bool>& is_wanted,
                      std::vector<MessageEntry>& entries) const {
    const McapRecord outer = mcap_record(source, chunk.at);
    const ChunkCache::Content content = pieces_.chunk(outer);
    ChunkBytes inner(*content, file_, chunk.at);
    McapRecord record;
    for (std::uint64_t at = 0; at < inner.size(); at = record.end()) {
      record = mcap_record(inner, at);
      if (record.op != McapOp::kMessage) {
        continue;
      }
      const McapMessage message = mcap_message(inner, record);
      const auto topic = topic_of_.find(message.channel);
      if (topic != topic_of_.end() && is_wanted[topic->second]) {
        entries.push_back({message.log_time_ns, chunk.at, static_cast<std::uint32_t>(at), topic->second, 0});
      }
    }
  }

  McapPieces pieces_;
  const ReadableBytes& file_;
  std::vector<McapChunkIndex> chunks_;  // in the order of the file
  std::vector<MessageEntry> seen_;      // of a file without index
  McapChannels channels_;
  std::map<std::uint64_t, std::uint32_t> topic_of_;  // by channel
  std::optional<TimeSpan> span_;
};

}  // namespace

std::unique_ptr<FileBag> open_mcap(const std::filesystem::path& path, const std::filesystem::path& name) {
  return std::make_unique<McapFile>(path, name);
}

}  // namespace dynamic_icp::bags
