// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/odometry/frame.hpp"

// Labels, counts and objects of a frame, from what the points were found to be.
namespace dynamic_icp::odometry {

/// From the clusters of the frame. `cluster_labels`: per row, -1 for none. Fills the static points too.
void describe_clusters(Frame& frame, const Scan& scan, const std::vector<std::uint8_t>& is_dynamic,
                       const std::vector<std::int32_t>& cluster_labels);

/// From tracked objects, of which the confirmed ones become those of the frame. Counts over the `thinned` rows.
void describe_tracks(Frame& frame, const Scan& scan, const std::vector<std::uint8_t>& is_moving,
                     std::span<const std::uint32_t> thinned, std::span<const tracking::TrackedObject> objects,
                     const Workers& workers);

}  // namespace dynamic_icp::odometry
