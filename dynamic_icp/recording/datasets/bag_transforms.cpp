// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/bag_transforms.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/bag_stamps.hpp"
#include "dynamic_icp/recording/datasets/bag_topics.hpp"
#include "dynamic_icp/recording/formats/pose_interpolation.hpp"

namespace dynamic_icp::datasets {
namespace {

constexpr std::size_t kMessagesSearched = 400;  // for transforms that never change
constexpr double kUnchanged = 1e-9;
constexpr double kMaxGap_s = 2.0;  // between transforms that are interpolated

std::vector<std::size_t> topics_that(const bags::Bag& bag, bool (*passes)(const bags::Topic&)) {
  std::vector<std::size_t> topics;
  for (std::size_t k = 0; k < bag.topics().size(); ++k) {
    if (passes(bag.topics()[k])) {
      topics.push_back(k);
    }
  }
  return topics;
}

bool is_static_transforms(const bags::Topic& topic) {
  return messages::is_transforms(topic) && topic.name.ends_with("tf_static");
}

using UseTransform = std::function<void(const bags::MessageEntry& entry, const messages::StampedTransform& transform)>;

/// Every `step`th message of some topics, one transform after the other.
void for_each_transform(const bags::Bag& bag, const std::vector<std::size_t>& topics, std::size_t step,
                        const UseTransform& use) {
  const std::vector<bags::MessageEntry> entries = bag.messages(topics);
  for (std::size_t i = 0; i < entries.size(); i += step) {
    const std::string bytes = bag.read(entries[i]);
    for (const messages::StampedTransform& one :
         messages::decode_transforms(bag.topics().at(entries[i].topic), bytes, message_origin(bag, entries[i], i))) {
      use(entries[i], one);
    }
  }
}

std::string pair_of(const messages::StampedTransform& one) { return one.header.frame_id + '>' + one.child_frame_id; }

/// What is known of a pair of frames in topics that are not static.
struct Repeated {
  messages::StampedTransform first;
  std::size_t times = 0;
  bool is_unchanged = true;
};

/// The pairs from `parent` to `child`, the uppermost first, each frame being the child of the next one; empty: none.
std::vector<std::string> path_between(const std::set<std::string>& pairs, const std::string& parent,
                                      const std::string& child) {
  std::map<std::string, std::string> below;  // of the frames that were reached, the pair that leads down from each
  std::vector<std::string> reached = {child};
  for (std::size_t next = 0; next < reached.size(); ++next) {
    const std::string frame = reached[next];
    for (const std::string& pair : pairs) {
      const std::size_t arrow = pair.find('>');
      const std::string above = pair.substr(0, arrow);
      if (pair.substr(arrow + 1) == frame && above != child && below.emplace(above, pair).second) {
        reached.push_back(above);
      }
    }
  }
  std::vector<std::string> path;
  for (std::string frame = parent; frame != child;) {
    const auto pair = below.find(frame);
    if (pair == below.end()) {
      return {};
    }
    path.push_back(pair->second);
    frame = pair->second.substr(pair->second.find('>') + 1);
  }
  return path;
}

/// The poses of each of some pairs.
std::map<std::string, RecordedPoses> poses_of(const bags::Bag& bag, const std::vector<std::string>& pairs) {
  std::map<std::string, RecordedPoses> all;
  for_each_transform(bag, topics_that(bag, is_moving_transforms), 1,
                     [&](const bags::MessageEntry& entry, const messages::StampedTransform& one) {
                       const std::string pair = pair_of(one);
                       if (std::find(pairs.begin(), pairs.end(), pair) != pairs.end()) {
                         all[pair].add(bag, entry, one);
                       }
                     });
  return all;
}

/// The transforms of a path one after the other, for each of the pair that is sent most often.
RecordedPoses chained(const bags::Bag& bag, const std::vector<std::string>& path, const StaticFrames& frames) {
  const std::map<std::string, RecordedPoses> moving = poses_of(bag, path);
  const auto busiest = std::max_element(moving.begin(), moving.end(), [](const auto& a, const auto& b) {
    return a.second.poses.size() < b.second.poses.size();
  });
  RecordedPoses result;
  if (busiest == moving.end()) {
    return result;  // all static: nothing that moves
  }
  std::map<std::string, formats::Trajectory> trajectories;
  std::vector<std::string> ignored;  // what is odd of them is said of the poses they make
  for (const auto& [pair, recorded] : moving) {
    trajectories[pair] = trajectory_of(recorded, ignored);
  }
  result.file = busiest->second.file;
  for (const formats::StampedPose& at : trajectories.at(busiest->first)) {
    std::optional<Eigen::Isometry3d> T_parent_child = Eigen::Isometry3d::Identity();
    for (const std::string& pair : path) {
      const std::size_t arrow = pair.find('>');
      const auto trajectory = trajectories.find(pair);
      const std::optional<Eigen::Isometry3d> link =
          trajectory == trajectories.end() ? frames.transform(pair.substr(0, arrow), pair.substr(arrow + 1))
                                           : formats::pose_at(trajectory->second, at.stamp, kMaxGap_s);
      T_parent_child = T_parent_child && link ? std::optional(*T_parent_child * *link) : std::nullopt;
    }
    if (T_parent_child) {
      result.recorded_ns.push_back(at.stamp.ns);
      result.headers.push_back(at.stamp);
      result.poses.push_back(*T_parent_child);
    }
  }
  return result;
}

}  // namespace

void RecordedPoses::add(const bags::Bag& bag, const bags::MessageEntry& entry, const messages::StampedTransform& pose) {
  if (poses.empty()) {
    file = bag.file(entry);
    child = pose.child_frame_id;
  }
  recorded_ns.push_back(entry.recorded_ns);
  headers.push_back(pose.header.stamp);
  poses.push_back(pose.T_parent_child);
}

formats::Trajectory trajectory_of(const RecordedPoses& recorded, std::vector<std::string>& assumptions) {
  const ChosenStamps chosen = choose_stamps(recorded.recorded_ns, recorded.headers, recorded.name);
  assumptions.insert(assumptions.end(), chosen.assumptions.begin(), chosen.assumptions.end());
  formats::Trajectory trajectory;
  for (std::size_t k = 0; k < chosen.kept.size(); ++k) {
    trajectory.push_back({chosen.stamps[k], recorded.poses[chosen.kept[k]]});
  }
  return trajectory;
}

bool is_moving_transforms(const bags::Topic& topic) {
  return messages::is_transforms(topic) && !is_static_transforms(topic);
}

StaticFrames read_static_frames(const bags::Bag& bag) {
  StaticFrames frames;
  for_each_transform(
      bag, topics_that(bag, is_static_transforms), 1,
      [&](const bags::MessageEntry& /*entry*/, const messages::StampedTransform& one) { frames.add(one); });
  return frames;
}

std::size_t add_repeated_frames(const bags::Bag& bag, StaticFrames& frames) {
  const std::vector<std::size_t> topics = topics_that(bag, is_moving_transforms);
  std::map<std::string, Repeated> pairs;
  for_each_transform(bag, topics, 1 + bag.messages(topics).size() / kMessagesSearched,
                     [&](const bags::MessageEntry& /*entry*/, const messages::StampedTransform& one) {
                       Repeated& pair = pairs[pair_of(one)];
                       pair.first = pair.times == 0 ? one : pair.first;
                       pair.is_unchanged =
                           pair.is_unchanged && one.T_parent_child.isApprox(pair.first.T_parent_child, kUnchanged);
                       ++pair.times;
                     });
  std::size_t added = 0;
  for (const auto& [name, pair] : pairs) {
    if (pair.times > 1 && pair.is_unchanged && !StaticFrames::is_world(pair.first.header.frame_id) &&
        !frames.has_parent(pair.first.child_frame_id)) {
      frames.add(pair.first);
      ++added;
    }
  }
  return added;
}

RecordedPoses poses_of_pair(const bags::Bag& bag, const std::string& pair, const StaticFrames& frames) {
  std::set<std::string> pairs;
  RecordedPoses recorded;
  for_each_transform(bag, topics_that(bag, is_moving_transforms), 1,
                     [&](const bags::MessageEntry& entry, const messages::StampedTransform& one) {
                       const std::string name = pair_of(one);
                       pairs.insert(name);
                       if (name == pair) {
                         recorded.add(bag, entry, one);
                       }
                     });
  const std::set<std::string> moving = pairs;
  if (recorded.poses.empty()) {
    const std::vector<std::string> fixed = frames.pairs();
    pairs.insert(fixed.begin(), fixed.end());
    const std::size_t arrow = pair.find('>');
    recorded = chained(bag, path_between(pairs, pair.substr(0, arrow), pair.substr(arrow + 1)), frames);
    recorded.child = pair.substr(arrow + 1);
  }
  recorded.name = fmt::format("transform '{}'", pair);
  if (recorded.poses.empty()) {
    throw UsageError(
        fmt::format("truth-topic is '{}', but no transforms lead from one of these frames to the other; there are: {}",
                    pair, moving.empty() ? "none" : fmt::format("{}", fmt::join(moving, ", "))));
  }
  return recorded;
}

}  // namespace dynamic_icp::datasets
