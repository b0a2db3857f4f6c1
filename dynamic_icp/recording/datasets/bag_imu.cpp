// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/bag_imu.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/bag_stamps.hpp"
#include "dynamic_icp/recording/datasets/bag_topics.hpp"

namespace dynamic_icp::datasets {
namespace {

std::string imu_topic(const bags::Bag& bag, const std::string& wanted) {
  const std::vector<std::string> all =
      topic_names(bag, [](const bags::Topic& topic) { return messages::is_imu(topic) && topic.messages > 0; });
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& name) { return name == wanted || name == '/' + wanted; });
  if (found != all.end()) {
    return *found;
  }
  if (wanted.empty() && all.size() == 1) {
    return all.front();
  }
  throw UsageError(fmt::format("topic of the IMU is '{}', expected one of: {}", wanted,
                               all.empty() ? "none there" : fmt::format("{}", fmt::join(all, ", "))));
}

}  // namespace

ImuRecording read_imu(const bags::Bag& bag, const std::string& topic) {
  ImuRecording recording;
  recording.topic = imu_topic(bag, topic);
  std::vector<messages::Imu> all;
  std::vector<std::int64_t> recorded_ns;
  std::vector<Stamp> headers;
  for_each_message(
      bag, topics_named(bag, recording.topic),
      [&](const bags::Topic& of, const bags::MessageEntry& entry, const std::string& bytes, const std::string& origin) {
        all.push_back(messages::decode_imu(of, bytes, origin));
        recorded_ns.push_back(entry.recorded_ns);
        headers.push_back(all.back().header.stamp);
      });
  const ChosenStamps chosen = choose_stamps(recorded_ns, headers, recording.topic);
  recording.assumptions = chosen.assumptions;
  for (std::size_t k = 0; k < chosen.kept.size(); ++k) {
    recording.measurements.push_back(std::move(all[chosen.kept[k]]));
    recording.measurements.back().header.stamp = chosen.stamps[k];
  }
  return recording;
}

ImuRecording read_imu(const std::filesystem::path& input, const std::string& topic) {
  const std::filesystem::path found = bags::find_bag(input, "");
  if (found.empty()) {
    throw DataError(fmt::format("{}: is no bag and holds none", input.string()));
  }
  return read_imu(*bags::open_bag(found), topic);
}

}  // namespace dynamic_icp::datasets
