// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/stamp.hpp"
#include "dynamic_icp/recording/bags/bag.hpp"
#include "dynamic_icp/recording/datasets/static_frames.hpp"
#include "dynamic_icp/recording/formats/trajectory.hpp"
#include "dynamic_icp/recording/messages/messages.hpp"

// The transforms of a bag: those that are static, and those that are poses.
namespace dynamic_icp::datasets {

/// Poses of one child frame, in the order of their recording.
struct RecordedPoses {
  std::string name;  ///< of the topic or the pair, for messages
  std::string child;
  std::filesystem::path file;
  std::vector<std::int64_t> recorded_ns;
  std::vector<Stamp> headers;
  std::vector<Eigen::Isometry3d> poses;

  void add(const bags::Bag& bag, const bags::MessageEntry& entry, const messages::StampedTransform& pose);
};

/// Those that are kept, with the stamps chosen for them (bag_stamps.hpp).
formats::Trajectory trajectory_of(const RecordedPoses& recorded, std::vector<std::string>& assumptions);

/// All transforms of topics named tf_static.
StaticFrames read_static_frames(const bags::Bag& bag);

/// Adds what other topics of transforms repeat without change and no static one says; how many those are. They are
/// sought in some hundred messages from all over the bag. What hangs on the world (map, odom, ...) is a pose, however
/// long the sensor stands.
std::size_t add_repeated_frames(const bags::Bag& bag, StaticFrames& frames);

/// Whether a topic has transforms that are poses.
bool is_moving_transforms(const bags::Topic& topic);

/// The poses of "parent>child" by the topics of transforms: of that pair where some message has it, else by way of the
/// frames between them, static or not: one pose for each transform of the pair that is sent most often, those of the
/// others interpolated to its time. Throws UsageError that names the pairs there are where none of it leads from one to
/// the other.
RecordedPoses poses_of_pair(const bags::Bag& bag, const std::string& pair, const StaticFrames& frames);

}  // namespace dynamic_icp::datasets
