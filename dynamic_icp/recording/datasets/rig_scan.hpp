// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "dynamic_icp/method/base/raw_scan.hpp"
#include "dynamic_icp/method/base/stamp.hpp"

// Scans of several sensors as one of a rig.
namespace dynamic_icp::datasets {

constexpr std::size_t kAbsent = std::numeric_limits<std::size_t>::max();

/// For each stamp, and each of the other rows of stamps, the index of the nearest of these within a distance; kAbsent
/// where there is none. One serves one stamp, the nearest. All in ascending order.
std::vector<std::vector<std::size_t>> nearest_in_time(const std::vector<Stamp>& stamps,
                                                      const std::vector<std::vector<Stamp>>& others,
                                                      double max_distance_s);

/// Adds the points of a sensor, whose mounting the rig has, in the frame and after the stamp of the rig. A channel that
/// one of the sensors lacks stays too short.
void append_sensor(const RawScan& scan, std::size_t sensor, bool has_times, RawScan& rig);

/// Removes the channels that stayed too short.
void drop_partial_channels(RawScan& rig);

}  // namespace dynamic_icp::datasets
