// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <numeric>
#include <ostream>
#include <string>
#include <vector>

#include "dynamic_icp/recording/bags/bag.hpp"

// For tests: all that a bag holds.
namespace dynamic_icp::bags {

struct SeenMessage {
  std::string topic;
  std::int64_t time_ns = 0;
  std::string data;

  friend bool operator==(const SeenMessage&, const SeenMessage&) = default;
  friend std::ostream& operator<<(std::ostream& out, const SeenMessage& message) {
    return out << message.topic << " at " << message.time_ns << ", " << message.data.size() << " bytes";
  }
};

inline std::vector<std::size_t> all_topics(const Bag& bag) {
  std::vector<std::size_t> topics(bag.topics().size());
  std::iota(topics.begin(), topics.end(), std::size_t{0});
  return topics;
}

inline std::vector<SeenMessage> messages_of(const Bag& bag, const std::vector<std::size_t>& topics) {
  std::vector<SeenMessage> messages;
  for (const MessageEntry& entry : bag.messages(topics)) {
    messages.push_back({bag.topics().at(entry.topic).name, entry.recorded_ns, bag.read(entry)});
  }
  return messages;
}

inline std::vector<SeenMessage> messages_of(const Bag& bag) { return messages_of(bag, all_topics(bag)); }

}  // namespace dynamic_icp::bags
