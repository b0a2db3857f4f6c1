// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamic_icp/recording/bags/bag.hpp"
#include "dynamic_icp/recording/bags/growing_bytes.hpp"

namespace dynamic_icp::bags {

/// An MCAP file that still grows, or a stream of one: its records are read as they are complete. Its index, which comes
/// last, is not used. One thread at a time.
class FollowedMcap {
 public:
  explicit FollowedMcap(std::unique_ptr<GrowingBytes> bytes);
  ~FollowedMcap();
  FollowedMcap(const FollowedMcap&) = delete;
  FollowedMcap& operator=(const FollowedMcap&) = delete;

  /// As messages to the user name it.
  [[nodiscard]] const std::filesystem::path& path() const;

  struct NewMessage {
    MessageEntry entry;              ///< of the bag
    std::optional<Arrival> arrival;  ///< of its last byte; nothing where it was there before anybody looked
  };

  /// From now on messages of other topics count as none; null: there are no others.
  void keep_only(bool (*passes)(const Topic& topic));

  /// Waits for further records, but not longer than that, and takes what is there, but not more than so many. Throws
  /// DataError where they cannot come, or are damaged (Damage, which names the byte): what came before stays.
  void advance(std::chrono::milliseconds longest,
               std::uint64_t most_records = std::numeric_limits<std::uint64_t>::max());

  /// Whether no more messages will come.
  [[nodiscard]] bool is_over() const;

  /// How it ended where that was not as it should be, in a sentence that names the byte; else empty.
  [[nodiscard]] const std::string& cut() const;

  /// The number of messages that have come in this topic: the busiest of those that pass.
  [[nodiscard]] std::uint64_t most_messages(bool (*passes)(const Topic& topic)) const;

  /// Of the topic of that name; a slash in front may be left out.
  [[nodiscard]] std::uint64_t messages_of(const std::string& name) const;

  /// What has come so far as a bag, whose topics stay as they are. Bytes that were forgotten cannot be read from it.
  std::shared_ptr<const Bag> bag();

  /// The messages that came since they were taken last, in the order of the file; those of topics that the bag does not
  /// have are left out. The first time these are all: `come` of them are in the bag.
  std::vector<NewMessage> take_new();
  [[nodiscard]] std::size_t come() const;

  /// Bytes of a stream that are kept to be read again; of a file none.
  [[nodiscard]] std::uint64_t kept() const;

  /// What comes before the messages that were not taken yet is not read again.
  void forget_before_new();

  /// What comes before a message is not read again; without one, nothing that has come.
  void forget_before(const std::optional<MessageEntry>& entry);

 private:
  class SoFar;
  struct Come;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace dynamic_icp::bags
