// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/bag_truth.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/bag_topics.hpp"
#include "dynamic_icp/recording/datasets/bag_transforms.hpp"

namespace dynamic_icp::datasets {
namespace {

RecordedPoses poses_of_topic(const bags::Bag& bag, const std::string& name) {
  RecordedPoses recorded;
  recorded.name = fmt::format("topic '{}'", name);
  for_each_message(
      bag, topics_named(bag, name),
      [&](const bags::Topic& topic, const bags::MessageEntry& entry, const std::string& bytes,
          const std::string& origin) { recorded.add(bag, entry, messages::decode_pose(topic, bytes, origin)); });
  return recorded;
}

/// T_child_scan, or the identity with a sentence.
Eigen::Isometry3d child_to_scan(const RecordedPoses& recorded, const StaticFrames& frames, const ScanFrame& scans,
                                std::vector<std::string>& assumptions) {
  const std::optional<Eigen::Isometry3d> T_child_frame = recorded.child.empty() || scans.frame_id.empty()
                                                             ? std::nullopt
                                                             : frames.transform(recorded.child, scans.frame_id);
  if (T_child_frame) {
    return *T_child_frame * scans.T_frame_scan;
  }
  assumptions.push_back(
      recorded.child.empty()
          ? fmt::format(
                "ground truth: the poses of {} are taken as those of the sensor: its messages name no frame that "
                "moves",
                recorded.name)
          : fmt::format(
                "ground truth: the poses of {} are of frame '{}' and are taken as those of the sensor: no static "
                "transforms lead to its frame '{}'",
                recorded.name, recorded.child, scans.frame_id));
  return Eigen::Isometry3d::Identity();
}

/// Why the poses are not those of the scans; empty when they may be.
std::string time_misfit(const formats::Trajectory& poses, const std::vector<Stamp>& stamps) {
  if (poses.empty()) {
    return "it has no messages";
  }
  if (stamps.empty() || (poses.front().stamp <= stamps.back() && poses.back().stamp >= stamps.front())) {
    return "";
  }
  return fmt::format("its poses from {} to {} s are of another time than the scans from {} to {} s",
                     format_seconds(poses.front().stamp), format_seconds(poses.back().stamp),
                     format_seconds(stamps.front()), format_seconds(stamps.back()));
}

/// The topic to take where none is wanted; empty: none.
std::string topic_to_take(const bags::Bag& bag, std::vector<std::string>& assumptions) {
  const std::vector<std::string> all =
      topic_names(bag, [](const bags::Topic& topic) { return messages::is_pose(topic) && topic.messages > 0; });
  std::vector<std::string> named;
  std::copy_if(all.begin(), all.end(), std::back_inserter(named), is_named_ground_truth);
  if (named.size() == 1) {
    assumptions.push_back(fmt::format("ground truth is taken from topic '{}', by its name", named.front()));
    return named.front();
  }
  if (!all.empty()) {
    assumptions.push_back(
        named.empty()
            ? fmt::format("no ground truth is taken: name one of the topics of poses as truth-topic for that: {}",
                          fmt::join(all, ", "))
            : fmt::format("no ground truth is taken: several topics are called so, name one as truth-topic: {}",
                          fmt::join(named, ", ")));
  }
  return "";
}

/// The topic of poses of that name. Throws UsageError where it is none.
std::string checked_topic(const bags::Bag& bag, const std::string& wanted) {
  const std::vector<std::size_t> found = topics_named(bag, wanted);
  if (!found.empty() && messages::is_pose(bag.topics()[found.front()])) {
    return bag.topics()[found.front()].name;
  }
  std::vector<std::string> pose_topics = topic_names(bag, messages::is_pose);
  throw UsageError(fmt::format(
      "truth-topic is '{}', {}; topics of poses: {}{}", wanted,
      found.empty() ? "but there is no such topic"
                    : fmt::format("which is of {}, not of poses", bag.topics()[found.front()].type),
      pose_topics.empty() ? "none" : fmt::format("{}", fmt::join(pose_topics, ", ")),
      topic_names(bag, is_moving_transforms).empty() ? "" : "; of transforms a pair of frames, e.g. odom>base_link"));
}

}  // namespace

bool is_named_ground_truth(const std::string& topic) {
  std::string plain;
  std::vector<std::string> words(1);
  for (const char c : topic) {
    const char lower = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    const bool is_letter = lower >= 'a' && lower <= 'z';
    plain += is_letter ? std::string(1, lower) : "";
    if (is_letter) {
      words.back() += lower;
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  }
  return plain.find("groundtruth") != std::string::npos || std::find(words.begin(), words.end(), "gt") != words.end();
}

Truth bag_truth(const bags::Bag& bag, const std::string& wanted, const StaticFrames& frames, const ScanFrame& scans,
                std::vector<std::string>& assumptions) {
  const bool is_pair = wanted.find('>') != std::string::npos;
  const std::string topic = is_pair          ? ""
                            : wanted.empty() ? topic_to_take(bag, assumptions)
                                             : checked_topic(bag, wanted);
  if (!is_pair && topic.empty()) {
    return {};
  }
  const RecordedPoses recorded = is_pair ? poses_of_pair(bag, wanted, frames) : poses_of_topic(bag, topic);
  const Eigen::Isometry3d T_child_scan = child_to_scan(recorded, frames, scans, assumptions);
  formats::Trajectory poses = trajectory_of(recorded, assumptions);
  for (formats::StampedPose& pose : poses) {
    pose.T_world_sensor = pose.T_world_sensor * T_child_scan;
  }
  poses = near_origin(std::move(poses));
  if (const std::string misfit = time_misfit(poses, scans.stamps); !misfit.empty()) {
    if (!wanted.empty()) {
      throw DataError(fmt::format("{}: {}: {}", recorded.file.string(), recorded.name, misfit));
    }
    assumptions.push_back(fmt::format("{} is not used as ground truth: {}", recorded.name, misfit));
    return {};
  }
  return {std::move(poses), recorded.file};
}

}  // namespace dynamic_icp::datasets
