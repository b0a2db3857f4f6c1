// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/bag_clouds.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/quantile.hpp"
#include "dynamic_icp/recording/datasets/bag_stamps.hpp"
#include "dynamic_icp/recording/datasets/bag_topics.hpp"
#include "dynamic_icp/recording/messages/messages.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

/// Messages with the stamps in their headers.
struct Headers {
  std::vector<std::int64_t> recorded_ns;
  std::vector<Stamp> stamps;
};

/// The header of a message, by its front where that tells.
messages::Header header_of(const bags::Bag& bag, const bags::MessageEntry& entry, std::size_t number) {
  const bags::Topic& topic = bag.topics()[entry.topic];
  std::optional<messages::Header> header =
      messages::header_in_front(topic, bag.read_front(entry, messages::kFrontBytes));
  return header ? std::move(*header)
                : messages::decode_cloud(topic, bag.read(entry), message_origin(bag, entry, number)).header;
}

/// All messages of a topic; those behind the first that cannot be read are left out, which is said.
Headers read_headers(const bags::Bag& bag, const fs::path& path, CloudTopic& topic,
                     std::vector<std::string>& assumptions) {
  topic.entries = bag.messages(topics_named(bag, topic.name));
  std::erase_if(topic.entries, [&](const auto& entry) { return !messages::is_cloud(bag.topics()[entry.topic]); });
  if (topic.entries.empty()) {
    throw DataError(fmt::format("{}: topic '{}' has no messages", path.string(), topic.name));
  }
  Headers headers;
  for (std::size_t i = 0; i < topic.entries.size(); ++i) {
    try {
      headers.stamps.push_back(header_of(bag, topic.entries[i], i).stamp);
    } catch (const DataError& error) {
      if (i == 0) {
        throw;
      }
      assumptions.push_back(fmt::format("{}: this message and the {} behind it are left out", error.what(),
                                        topic.entries.size() - i - 1));
      topic.entries.resize(i);
      break;
    }
    headers.recorded_ns.push_back(topic.entries[i].recorded_ns);
  }
  return headers;
}

}  // namespace

void find_clouds(const bags::Bag& bag, const fs::path& path, std::vector<CloudTopic>& topics,
                 std::vector<std::string>& assumptions) {
  std::vector<Headers> headers;
  std::vector<ChosenStamps> chosen;
  for (CloudTopic& topic : topics) {
    headers.push_back(read_headers(bag, path, topic, assumptions));
    chosen.push_back(choose_stamps(headers.back().recorded_ns, headers.back().stamps, topic.name));
  }
  const bool are_recorded =
      std::any_of(chosen.begin(), chosen.end(), [](const ChosenStamps& c) { return c.are_recorded; });
  for (std::size_t k = 0; k < topics.size(); ++k) {
    CloudTopic& topic = topics[k];
    if (are_recorded && !chosen[k].are_recorded) {
      chosen[k] = recorded_stamps(headers[k].recorded_ns, topic.name);
    }
    assumptions.insert(assumptions.end(), chosen[k].assumptions.begin(), chosen[k].assumptions.end());
    topic.messages = topic.entries.size();
    topic.are_recorded = chosen[k].are_recorded;
    std::vector<bags::MessageEntry> kept;
    for (const std::size_t message : chosen[k].kept) {
      kept.push_back(topic.entries[message]);
    }
    topic.entries = std::move(kept);
    topic.numbers = std::move(chosen[k].kept);
    topic.stamps = std::move(chosen[k].stamps);
  }
}

std::string add_cloud(const bags::Bag& bag, CloudTopic& topic, const bags::MessageEntry& entry) {
  const std::size_t number = topic.messages++;
  const Stamp stamp = topic.are_recorded ? Stamp{entry.recorded_ns} : header_of(bag, entry, number).stamp;
  const auto left_out = [&](const std::string& why) {
    return fmt::format("{}: is left out: its timestamp, {} s, {}", message_origin(bag, entry, number),
                       format_seconds(stamp), why);
  };
  if (!topic.are_recorded && !is_sane(stamp, entry.recorded_ns)) {
    return left_out("is over an hour away from the time of recording");
  }
  if (!topic.stamps.empty() && stamp <= topic.stamps.back()) {
    return left_out(fmt::format("is not after that of the scan before it, {} s", format_seconds(topic.stamps.back())));
  }
  topic.entries.push_back(entry);
  topic.numbers.push_back(number);
  topic.stamps.push_back(stamp);
  return {};
}

double period_of(const CloudTopic& topic, double otherwise_s) {
  std::vector<double> periods;
  for (std::size_t i = 1; i < topic.stamps.size(); ++i) {
    periods.push_back(seconds_between(topic.stamps[i - 1], topic.stamps[i]));
  }
  return periods.empty() ? otherwise_s : median(std::move(periods));
}

}  // namespace dynamic_icp::datasets
