// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/bag_info.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/messages/cloud_columns.hpp"

namespace dynamic_icp::apps {

using Json = nlohmann::ordered_json;

std::optional<datasets::BagSummary> bag_of(const std::string& input, const datasets::InputSettings& settings) {
  const datasets::FoundDataset found = datasets::find_dataset(input, settings.open);
  return found.is_bag() ? std::optional(datasets::summarize_bag(found.path)) : std::nullopt;
}

bool has_clouds(const datasets::BagSummary& bag) {
  return std::any_of(bag.topics.begin(), bag.topics.end(),
                     [](const datasets::TopicSummary& topic) { return topic.is_cloud && topic.messages > 0; });
}

void print_topics(const datasets::BagSummary& bag) {
  for (const datasets::TopicSummary& topic : bag.topics) {
    fmt::print("topic        {}\n", datasets::topic_line(topic));
  }
}

Json topics_json(const datasets::BagSummary& bag) {
  Json topics = Json::array();
  for (const datasets::TopicSummary& topic : bag.topics) {
    Json json = {{"name", topic.name},
                 {"type", topic.type},
                 {"encoding", topic.encoding},
                 {"messages", topic.messages},
                 {"rate_hz", topic.rate_hz ? Json(*topic.rate_hz) : Json(nullptr)}};
    if (topic.is_cloud) {
      json["fields"] = Json::array();
      for (const messages::PointField& field : topic.fields) {
        json["fields"].push_back(
            {{"name", field.name}, {"type", messages::name_of(field.type)}, {"count", field.count}});
      }
    }
    topics.push_back(std::move(json));
  }
  return topics;
}

}  // namespace dynamic_icp::apps
