// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/stamp.hpp"
#include "dynamic_icp/recording/bags/bag.hpp"
#include "dynamic_icp/recording/datasets/column_scan.hpp"

namespace dynamic_icp::datasets {

/// The clouds of one topic: its messages that are kept, and how they are read.
struct CloudTopic {
  std::string name;
  std::vector<bags::MessageEntry> entries;
  std::vector<std::size_t> numbers;  ///< of the messages among all of the topic
  std::vector<Stamp> stamps;
  std::size_t messages = 0;   ///< of the topic, kept or not
  bool are_recorded = false;  ///< stamps are the times of recording
  std::string frame_id;
  Eigen::Isometry3d T_frame_cloud = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_scan_sensor = Eigen::Isometry3d::Identity();
  ColumnMeaning meaning;
};

/// Finds the messages of each topic, by its name, and their stamps. One clock for all: where one topic has to go by the
/// times of recording, all do. Messages behind the first that cannot be read are left out, which is said; so are those
/// out of order (bag_stamps.hpp). Throws DataError for a topic without messages, or whose first cannot be read; `path`
/// names the bag.
void find_clouds(const bags::Bag& bag, const std::filesystem::path& path, std::vector<CloudTopic>& topics,
                 std::vector<std::string>& assumptions);

/// Takes over a message that comes behind all others of a topic, in a bag that grows. Why it is left out: its stamp is
/// not after that of the cloud before it, or not sane (bag_stamps.hpp); empty where it is kept. Throws DataError where
/// it is damaged.
std::string add_cloud(const bags::Bag& bag, CloudTopic& topic, const bags::MessageEntry& entry);

/// From one cloud to the next, median; `otherwise_s` of fewer than two.
double period_of(const CloudTopic& topic, double otherwise_s);

}  // namespace dynamic_icp::datasets
