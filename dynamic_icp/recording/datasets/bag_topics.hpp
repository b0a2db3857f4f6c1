// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dynamic_icp/recording/bags/bag.hpp"
#include "dynamic_icp/recording/messages/messages.hpp"

namespace dynamic_icp::datasets {

/// What a bag has of one topic.
struct TopicSummary {
  std::string name;
  std::string type;
  std::string encoding;
  std::uint64_t messages = 0;
  std::optional<double> rate_hz;                  ///< by the times of recording; nothing for fewer than two messages
  bool is_cloud = false;                          ///< its messages are clouds of points that are read
  std::vector<messages::PointField> fields = {};  ///< of a cloud's points, by its first message
  std::string frame_id = {};                      ///< of a cloud, by the same
  std::string fault = {};                         ///< why the first message cannot be read; else empty
};

struct BagSummary {
  std::string container;  ///< as --format takes it
  std::filesystem::path path;
  std::vector<TopicSummary> topics;  ///< in the order of their names
  std::vector<std::string> notes;    ///< what was odd but could be lived with
};

/// What a bag holds. Reads its index and the first message of each topic of clouds.
BagSummary summarize_bag(const bags::Bag& bag, const std::filesystem::path& path);

/// The same of a bag that is found (bags::find_bag).
BagSummary summarize_bag(const std::filesystem::path& path);

/// "/points: sensor_msgs/PointCloud2, 412 messages at 10.0 Hz; x, y, z, velocity (float32)"
std::string topic_line(const TopicSummary& topic);

/// What messages begin with that speak of one message of a bag, the `number`th of its topic from 0 on.
std::string message_origin(const bags::Bag& bag, const bags::MessageEntry& entry, std::size_t number);

/// The topics of that name, as indices: one for each definition. A slash in front may be left out.
std::vector<std::size_t> topics_named(const bags::Bag& bag, const std::string& name);

/// The names of topics that pass a test, each once.
std::vector<std::string> topic_names(const bags::Bag& bag, const std::function<bool(const bags::Topic&)>& passes);

/// Reads all messages of some topics in the order of their recording.
void for_each_message(const bags::Bag& bag, const std::vector<std::size_t>& topics,
                      const std::function<void(const bags::Topic& topic, const bags::MessageEntry& entry,
                                               const std::string& bytes, const std::string& origin)>& use);

}  // namespace dynamic_icp::datasets
