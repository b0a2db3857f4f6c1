// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/bag_stamps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/quantile.hpp"

namespace dynamic_icp::datasets {
namespace {

constexpr double kFar_s = 3600.0;
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// By way of doubles: headers may hold any number, and differences of such integers overflow.
double distance_s(Stamp header, std::int64_t recorded_ns) {
  return 1e-9 * (static_cast<double>(header.ns) - static_cast<double>(recorded_ns));
}

/// Of messages with some stamps, those in order.
ChosenStamps in_order(std::vector<std::size_t> messages, const std::vector<Stamp>& stamps, const std::string& topic) {
  ChosenStamps chosen;
  const std::vector<std::size_t> kept = longest_increasing(stamps);
  for (const std::size_t k : kept) {
    chosen.kept.push_back(messages[k]);
    chosen.stamps.push_back(stamps[k]);
  }
  if (kept.size() < stamps.size()) {
    chosen.assumptions.push_back(
        fmt::format("topic '{}': {} of {} messages are left out: their timestamps are not in order, or equal", topic,
                    stamps.size() - kept.size(), stamps.size()));
  }
  return chosen;
}

/// Why the headers are not taken, of which so many are sane.
std::string what_is_wrong(std::span<const std::int64_t> recorded_ns, std::span<const Stamp> headers, std::size_t sane) {
  const auto zeros =
      static_cast<std::size_t>(std::count_if(headers.begin(), headers.end(), [](Stamp h) { return h.ns == 0; }));
  if (zeros == headers.size()) {
    return "are 0";
  }
  if (2 * sane > headers.size()) {
    return "are not in order";
  }
  std::vector<double> distances_s;
  for (std::size_t i = 0; i < headers.size(); ++i) {
    if (headers[i].ns != 0) {
      distances_s.push_back(distance_s(headers[i], recorded_ns[i]));
    }
  }
  const double middle_s = median(std::move(distances_s));
  return fmt::format("{}lie {:.0f} s {} the times of recording",
                     zeros == 0 ? "" : fmt::format("are 0 in {} of {} messages, or ", zeros, headers.size()),
                     std::abs(middle_s), middle_s < 0.0 ? "before" : "after");
}

}  // namespace

bool is_sane(Stamp header, std::int64_t recorded_ns) { return std::abs(distance_s(header, recorded_ns)) <= kFar_s; }

std::vector<std::size_t> longest_increasing(std::span<const Stamp> stamps) {
  std::vector<std::size_t> ends;  // the stamp with which the best sequence of each length ends
  std::vector<std::size_t> before(stamps.size(), kNone);
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const auto at = std::lower_bound(ends.begin(), ends.end(), stamps[i],
                                     [&](std::size_t end, Stamp stamp) { return stamps[end] < stamp; });
    if (at != ends.begin()) {
      before[i] = *std::prev(at);
    }
    if (at == ends.end()) {
      ends.push_back(i);
    } else if (stamps[i] < stamps[*at]) {  // of equal ones the first stays
      *at = i;
    }
  }
  std::vector<std::size_t> sequence(ends.size());
  std::size_t next = ends.empty() ? kNone : ends.back();
  for (std::size_t k = sequence.size(); k-- > 0; next = before[next]) {
    sequence[k] = next;
  }
  return sequence;
}

ChosenStamps recorded_stamps(std::span<const std::int64_t> recorded_ns, const std::string& topic) {
  std::vector<std::size_t> messages;
  std::vector<Stamp> stamps;
  for (std::size_t i = 0; i < recorded_ns.size(); ++i) {
    messages.push_back(i);
    stamps.push_back({recorded_ns[i]});
  }
  ChosenStamps chosen = in_order(std::move(messages), stamps, topic);
  chosen.are_recorded = true;
  return chosen;
}

ChosenStamps choose_stamps(std::span<const std::int64_t> recorded_ns, std::span<const Stamp> headers,
                           const std::string& topic) {
  std::vector<std::size_t> messages;
  std::vector<Stamp> stamps;
  for (std::size_t i = 0; i < headers.size(); ++i) {
    if (is_sane(headers[i], recorded_ns[i])) {
      messages.push_back(i);
      stamps.push_back(headers[i]);
    }
  }
  const std::size_t sane = stamps.size();
  ChosenStamps chosen = in_order(std::move(messages), stamps, topic);
  if (2 * chosen.kept.size() <= headers.size() && !headers.empty()) {
    ChosenStamps recorded = recorded_stamps(recorded_ns, topic);
    recorded.assumptions.insert(
        recorded.assumptions.begin(),
        fmt::format("topic '{}': the timestamps in its headers {}: the times of recording are taken", topic,
                    what_is_wrong(recorded_ns, headers, sane)));
    return recorded;
  }
  if (sane < headers.size()) {
    chosen.assumptions.push_back(fmt::format(
        "topic '{}': {} of {} messages are left out: the timestamps in their headers are 0, or over an hour "
        "away from the times of recording",
        topic, headers.size() - sane, headers.size()));
  }
  return chosen;
}

}  // namespace dynamic_icp::datasets
