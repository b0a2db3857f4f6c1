// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dynamic_icp/method/base/stamp.hpp"
#include "dynamic_icp/recording/datasets/bag_clouds.hpp"

// Which clouds of the topics of a rig make a scan: one of the first topic, and of each other topic the nearest in time.
namespace dynamic_icp::datasets {

/// The last of some ascending stamps that is before another one, or the first; their number where there are none.
std::size_t last_before(const std::vector<Stamp>& stamps, Stamp stamp);

/// Whether nothing that may still come changes which clouds of the others go with cloud `index` of the first topic.
bool is_settled(std::span<const CloudTopic> topics, std::size_t index);

/// For cloud `index` of the first topic the nearest of each of the others, no farther than `max_distance_s`; kAbsent:
/// there is none.
std::vector<std::size_t> nearest_clouds(std::span<const CloudTopic> topics, std::size_t index, double max_distance_s);

}  // namespace dynamic_icp::datasets
