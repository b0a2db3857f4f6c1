// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "dynamic_icp/method/base/stamp.hpp"
#include "dynamic_icp/recording/bags/bag.hpp"
#include "dynamic_icp/recording/datasets/static_frames.hpp"
#include "dynamic_icp/recording/datasets/truth.hpp"

namespace dynamic_icp::datasets {

/// Where the points of a bag's scans are, and when.
struct ScanFrame {
  std::string frame_id;                                            ///< empty: not known
  Eigen::Isometry3d T_frame_scan = Eigen::Isometry3d::Identity();  ///< the scans' own origin in it
  std::vector<Stamp> stamps;
};

/// The ground truth of a bag. `wanted` is a topic of poses, or "parent>child" for the transforms of that pair in topics
/// that are not static; empty: the only topic of poses whose name says ground truth ("gt", "ground_truth",
/// "groundtruth"), else none, and a sentence names the topics of poses there are. An odometry is no ground truth before
/// the user says so.
///
/// Poses are of the child frame of their messages and are moved to the scans by the static transforms; where messages
/// name no child, or none leads to the scans, they are taken as the scans' own, with a sentence. Their stamps are
/// chosen as those of clouds are (bag_stamps.hpp).
///
/// Throws UsageError where there is no such topic or pair, naming those there are; DataError where a message is damaged
/// or the wanted poses are of another time than the scans. What is not wanted but found is left out then, with a
/// sentence.
Truth bag_truth(const bags::Bag& bag, const std::string& wanted, const StaticFrames& frames, const ScanFrame& scans,
                std::vector<std::string>& assumptions);

/// Whether the name of a topic says that it is ground truth.
bool is_named_ground_truth(const std::string& topic);

}  // namespace dynamic_icp::datasets
