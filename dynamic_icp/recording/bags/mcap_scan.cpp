// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/bags/mcap_scan.hpp"

#include <fmt/format.h>

namespace dynamic_icp::bags {

void McapScan::advance(std::uint64_t most_records) {
  FileBytes source(pieces_.file());
  if (at_ == 0 && source.size() >= kMcapMagic.size()) {
    if (source.bytes(0, kMcapMagic.size()) != kMcapMagic) {
      throw source.damage(0, "expected the mark of an MCAP file");
    }
    at_ = kMcapMagic.size();
  }
  for (std::uint64_t taken = 0; at_ > 0 && !has_ended_; ++taken) {
    needed_ = at_ + McapRecord::kHeadBytes;
    if (source.size() < needed_ || taken == most_records) {
      return;
    }
    const McapRecord record = mcap_record(source, at_);
    has_ended_ = record.op == McapOp::kDataEnd || record.op == McapOp::kFooter;
    needed_ = record.end();
    if (has_ended_ || source.size() < needed_) {
      return;
    }
    take(source, record);
    at_ = record.end();
  }
}

void McapScan::take_cut() {
  FileBytes source(pieces_.file());
  if (has_ended_ || (at_ == source.size() && at_ > 0)) {
    return;
  }
  if (at_ == 0) {
    throw source.damage(0, "expected the mark of an MCAP file");
  }
  const McapRecord record = mcap_record(source, at_);
  if (record.op == McapOp::kChunk) {
    take_content(pieces_.cut_chunk(record), record);
  } else {
    take_record(source, record, record.at, 0, record.end());
  }
  throw source.damage(record.at, fmt::format("a record of {} bytes, of which {} are there", record.size,
                                             source.size() - record.content_at));
}

void McapScan::take(ByteSource& source, const McapRecord& record) {
  if (record.op == McapOp::kChunk) {
    take_content(*pieces_.chunk(record), record);
  } else {
    take_record(source, record, record.at, 0, record.end());
  }
}

void McapScan::take_content(std::string_view content, const McapRecord& chunk) {
  ChunkBytes inner(content, pieces_.file(), chunk.at);
  McapRecord record;
  for (std::uint64_t offset = 0; offset < inner.size(); offset = record.end()) {
    record = mcap_record(inner, offset);
    take_record(inner, record, chunk.at, offset, chunk.end());
  }
}

void McapScan::take_record(ByteSource& source, const McapRecord& record, std::uint64_t place, std::uint64_t offset,
                           std::uint64_t end) {
  if (record.op == McapOp::kSchema) {
    channels_.add_schema(mcap_content(source, record));
  } else if (record.op == McapOp::kChannel) {
    channels_.add_channel(mcap_content(source, record));
  } else if (record.op == McapOp::kMessage) {
    const McapMessage message = mcap_message(source, record);
    if (!channels_.has(message.channel)) {
      throw source.damage(record.at, fmt::format("a message of channel {}, which does not exist", message.channel));
    }
    channels_.count(message.channel, 1);
    seen_.push_back({{message.log_time_ns, place, static_cast<std::uint32_t>(offset), message.channel, 0}, end});
  }
}

}  // namespace dynamic_icp::bags
