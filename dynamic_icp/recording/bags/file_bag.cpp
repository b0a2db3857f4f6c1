// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/bags/file_bag.hpp"

#include <algorithm>
#include <iterator>
#include <tuple>

namespace dynamic_icp::bags {
namespace {

auto identity_of(const Topic& topic) { return std::tie(topic.name, topic.type, topic.encoding_name, topic.schema); }

}  // namespace

TopicTable table_of(const std::map<std::uint64_t, Topic>& channels) {
  TopicTable table;
  std::vector<const std::pair<const std::uint64_t, Topic>*> sorted;
  sorted.reserve(channels.size());
  for (const auto& channel : channels) {
    sorted.push_back(&channel);
  }
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto* a, const auto* b) { return identity_of(a->second) < identity_of(b->second); });
  for (const auto* const channel : sorted) {
    if (table.topics.empty() || identity_of(table.topics.back()) != identity_of(channel->second)) {
      table.topics.push_back(channel->second);
    } else {
      table.topics.back().messages += channel->second.messages;
    }
    table.topic_of[channel->first] = static_cast<std::uint32_t>(table.topics.size() - 1);
  }
  return table;
}

std::string plain_type(std::string_view type) {
  std::string plain;
  for (const char letter : type) {  // "::" becomes "/"
    if (letter != ':') {
      plain += letter;
    } else if (!plain.ends_with('/')) {
      plain += '/';
    }
  }
  for (const std::string_view part : {"/msg/", "/dds_/"}) {
    if (const std::size_t at = plain.find(part); at != std::string::npos) {
      plain.erase(at, part.size() - 1);
      if (part == "/dds_/" && plain.ends_with('_')) {
        plain.pop_back();
      }
    }
  }
  constexpr std::string_view kFoxglove = "foxglove/";
  if (plain.starts_with(kFoxglove)) {
    plain[kFoxglove.size() - 1] = '.';
  }
  return plain;
}

std::vector<bool> chosen(std::span<const std::size_t> wanted, std::size_t topics) {
  std::vector<bool> is_wanted(topics, false);
  for (const std::size_t topic : wanted) {
    is_wanted.at(topic) = true;
  }
  return is_wanted;
}

std::vector<MessageEntry> of_topics(std::span<const MessageEntry> entries, const std::vector<bool>& is_wanted) {
  std::vector<MessageEntry> wanted;
  std::copy_if(entries.begin(), entries.end(), std::back_inserter(wanted),
               [&](const MessageEntry& entry) { return is_wanted[entry.topic]; });
  return wanted;
}

void sort_by_time(std::vector<MessageEntry>& entries) {
  const auto key = [](const MessageEntry& e) { return std::tie(e.recorded_ns, e.file, e.place, e.offset); };
  std::sort(entries.begin(), entries.end(),
            [&](const MessageEntry& a, const MessageEntry& b) { return key(a) < key(b); });
}

}  // namespace dynamic_icp::bags
