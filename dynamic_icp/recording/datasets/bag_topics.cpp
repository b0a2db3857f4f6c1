// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/bag_topics.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/messages/cloud_columns.hpp"

namespace dynamic_icp::datasets {
namespace {

/// "x, y, z (float32), ring (uint16)"
std::string fields_text(const std::vector<messages::PointField>& fields) {
  std::string text;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    text += (k == 0 ? "" : ", ") + fields[k].name + (fields[k].count > 1 ? fmt::format("[{}]", fields[k].count) : "");
    if (k + 1 == fields.size() || fields[k + 1].type != fields[k].type) {
      text += fmt::format(" ({})", messages::name_of(fields[k].type));
    }
  }
  return text;
}

TopicSummary summary_of(const bags::Bag& bag, std::size_t index) {
  const bags::Topic& topic = bag.topics()[index];
  TopicSummary summary{topic.name, topic.type, topic.encoding_name, topic.messages, {}, messages::is_cloud(topic)};
  const std::vector<bags::MessageEntry> entries = bag.messages(std::array{index});
  if (entries.empty()) {
    return summary;
  }
  const double span_s = seconds_between({entries.front().recorded_ns}, {entries.back().recorded_ns});
  if (entries.size() > 1 && span_s > 0.0) {
    summary.rate_hz = static_cast<double>(entries.size() - 1) / span_s;
  }
  if (summary.is_cloud) {
    try {
      messages::PointCloud cloud =
          messages::decode_cloud(topic, bag.read(entries.front()), message_origin(bag, entries.front(), 0));
      summary.fields = std::move(cloud.fields);
      summary.frame_id = std::move(cloud.header.frame_id);
    } catch (const DataError& error) {
      summary.fault = error.what();
    }
  }
  return summary;
}

}  // namespace

BagSummary summarize_bag(const bags::Bag& bag, const std::filesystem::path& path) {
  BagSummary summary{std::string(bag.container()), path, {}, bag.notes()};
  for (std::size_t index = 0; index < bag.topics().size(); ++index) {
    summary.topics.push_back(summary_of(bag, index));
  }
  return summary;
}

BagSummary summarize_bag(const std::filesystem::path& path) { return summarize_bag(*bags::open_bag(path), path); }

std::string topic_line(const TopicSummary& topic) {
  std::string line = fmt::format("{}: {}, {} message{}", topic.name, topic.type.empty() ? "no type" : topic.type,
                                 topic.messages, topic.messages == 1 ? "" : "s");
  if (topic.rate_hz) {
    line += fmt::format(" at {:.1f} Hz", *topic.rate_hz);
  }
  if (!topic.fields.empty()) {
    line += "; " + fields_text(topic.fields);
  }
  return topic.fault.empty() ? line : line + "; " + topic.fault;
}

std::string message_origin(const bags::Bag& bag, const bags::MessageEntry& entry, std::size_t number) {
  return fmt::format("{}: {}, message {}", bag.file(entry).string(), bag.topics().at(entry.topic).name, number);
}

std::vector<std::size_t> topics_named(const bags::Bag& bag, const std::string& name) {
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < bag.topics().size(); ++k) {
    if (bag.topics()[k].name == name || bag.topics()[k].name == '/' + name) {
      found.push_back(k);
    }
  }
  return found;
}

std::vector<std::string> topic_names(const bags::Bag& bag, const std::function<bool(const bags::Topic&)>& passes) {
  std::vector<std::string> names;
  for (const bags::Topic& topic : bag.topics()) {
    if (passes(topic) && std::find(names.begin(), names.end(), topic.name) == names.end()) {
      names.push_back(topic.name);
    }
  }
  return names;
}

void for_each_message(const bags::Bag& bag, const std::vector<std::size_t>& topics,
                      const std::function<void(const bags::Topic& topic, const bags::MessageEntry& entry,
                                               const std::string& bytes, const std::string& origin)>& use) {
  const std::vector<bags::MessageEntry> entries = bag.messages(topics);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    use(bag.topics().at(entries[i].topic), entries[i], bag.read(entries[i]), message_origin(bag, entries[i], i));
  }
}

}  // namespace dynamic_icp::datasets
