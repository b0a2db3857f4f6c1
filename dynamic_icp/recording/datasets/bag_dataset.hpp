// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>

#include "dynamic_icp/recording/bags/bag.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/datasets/unclear_input.hpp"

namespace dynamic_icp::datasets {

/// The clouds of a bag as scans.
///
/// Taken is the topic of the options, else the only topic of clouds whose points have a Doppler by the names of their
/// fields (field_names.hpp). Several topics of the options are a rig: a scan for each cloud of the first topic, with
/// the nearest of each other one within half a period, moved into the frame of the first by the static transforms of
/// /tf_static; each point keeps its line of sight and the number of its topic.
///
/// Stamps are those of headers where these are sane (bag_stamps.hpp), the mounting is what /tf_static says, and ground
/// truth is what bag_truth.hpp finds. Opening reads the front of each cloud; memory grows with their number only.
///
/// `path` is what messages name for the whole bag. Throws DataError that lists the topics where there is no
/// cloud, UnclearInput where more than one, or none, could be meant; UsageError for topics that are not there.
std::unique_ptr<Dataset> open_bag_dataset(std::shared_ptr<const bags::Bag> bag, const std::filesystem::path& path,
                                          const OpenOptions& options);

}  // namespace dynamic_icp::datasets
