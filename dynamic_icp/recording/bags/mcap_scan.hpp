// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "dynamic_icp/recording/bags/bag.hpp"
#include "dynamic_icp/recording/bags/mcap_pieces.hpp"
#include "dynamic_icp/recording/bags/mcap_records.hpp"

namespace dynamic_icp::bags {

/// Looks through the records of an MCAP file from its front on, without its index: of a file that has none, and of one
/// that still grows.
class McapScan {
 public:
  /// A message that was seen. Its topic is the number of its channel.
  struct Seen {
    MessageEntry entry;
    std::uint64_t end = 0;  ///< of the record of the file that it is, or is part of
  };

  /// The pieces must outlive it.
  explicit McapScan(const McapPieces& pieces) : pieces_(pieces) {}

  /// Takes all records that are wholly there, but not more than so many, up to the end of the data. Throws Damage; what
  /// comes before it is kept.
  void advance(std::uint64_t most_records = std::numeric_limits<std::uint64_t>::max());

  /// Takes what is there of a record that the end of the file cuts, and throws Damage that says where; nothing where
  /// the file ends between two records.
  void take_cut();

  /// Whether the end of the data was seen: no messages come behind it.
  [[nodiscard]] bool has_ended() const { return has_ended_; }

  /// Where the next record begins, and as many bytes as the file must have before `advance` can take more of it.
  [[nodiscard]] std::uint64_t at() const { return at_; }
  [[nodiscard]] std::uint64_t needed() const { return needed_; }

  [[nodiscard]] const McapChannels& channels() const { return channels_; }

  /// The messages that were seen since it was asked last, in the order of the file.
  std::vector<Seen> take_seen() { return std::exchange(seen_, {}); }

 private:
  void take(ByteSource& source, const McapRecord& record);
  void take_content(std::string_view content, const McapRecord& chunk);
  void take_record(ByteSource& source, const McapRecord& record, std::uint64_t place, std::uint64_t offset,
                   std::uint64_t end);

  const McapPieces& pieces_;
  std::uint64_t at_ = 0;
  std::uint64_t needed_ = kMcapMagic.size();
  bool has_ended_ = false;
  McapChannels channels_;
  std::vector<Seen> seen_;
};

}  // namespace dynamic_icp::bags
