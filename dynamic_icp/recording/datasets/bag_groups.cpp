// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/bag_groups.hpp"

#include <algorithm>
#include <iterator>

#include "dynamic_icp/recording/datasets/rig_scan.hpp"

namespace dynamic_icp::datasets {
namespace {

constexpr std::size_t kLateSensor = 3;  // scans after which a sensor of a rig is not waited for

}  // namespace

std::size_t last_before(const std::vector<Stamp>& stamps, Stamp stamp) {
  const auto at = std::lower_bound(stamps.begin(), stamps.end(), stamp);
  return static_cast<std::size_t>((at == stamps.begin() ? at : std::prev(at)) - stamps.begin());
}

bool is_settled(std::span<const CloudTopic> topics, std::size_t index) {
  const std::vector<Stamp>& stamps = topics.front().stamps;
  const bool is_rig = topics.size() > 1;
  return (!is_rig || index + 1 < stamps.size()) && std::ranges::all_of(topics.subspan(1), [&](const CloudTopic& topic) {
           return (!topic.stamps.empty() && topic.stamps.back() >= stamps[index]) ||
                  index + kLateSensor < stamps.size();
         });
}

std::vector<std::size_t> nearest_clouds(std::span<const CloudTopic> topics, std::size_t index, double max_distance_s) {
  const std::vector<Stamp>& stamps = topics.front().stamps;
  const auto begin = stamps.begin() + static_cast<std::ptrdiff_t>(index);
  const std::vector<Stamp> this_and_next(begin, begin + std::min<std::ptrdiff_t>(2, stamps.end() - begin));
  std::vector<std::size_t> before;
  std::vector<std::vector<Stamp>> near;
  for (const CloudTopic& topic : topics.subspan(1)) {
    const std::vector<Stamp>& others = topic.stamps;
    before.push_back(last_before(others, stamps[index]));
    const std::size_t end = std::min(others.size(), before.back() + 3);
    near.emplace_back(others.begin() + static_cast<std::ptrdiff_t>(before.back()),
                      others.begin() + static_cast<std::ptrdiff_t>(end));
  }
  std::vector<std::size_t> group = nearest_in_time(this_and_next, near, max_distance_s).front();
  for (std::size_t k = 0; k < group.size(); ++k) {
    group[k] = group[k] == kAbsent ? kAbsent : group[k] + before[k];
  }
  return group;
}

}  // namespace dynamic_icp::datasets
