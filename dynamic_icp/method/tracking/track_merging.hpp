// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Geometry>

#include "dynamic_icp/method/tracking/range_image.hpp"
#include "dynamic_icp/method/tracking/track.hpp"
#include "dynamic_icp/method/tracking/tracker_config.hpp"

namespace dynamic_icp::tracking {

/// A track with what one scan shows of it.
struct SeenTrack {
  const Track& predicted;                       ///< at the stamp
  const BoxEstimate& now;                       ///< of it
  std::size_t points = 0;                       ///< of the scan; none: it is hidden
  std::span<const Eigen::Vector3d> where = {};  ///< m, world: some of them, if the box may have drifted away from them
};

/// Whether what has so many points of a scan may be a bit of what has so many.
bool is_splinter(std::size_t points, std::size_t of_points);

/// Whether two tracks are one body: one has its centre in what was seen of the other, or it is a splinter beside it or
/// where more of it is likely, that moves as it does, or both are sides of one body with nothing to be seen between
/// them in the scan that `view` shows.
bool are_same_object(const SeenTrack& a, const SeenTrack& b, const RangeImage& view,
                     const Eigen::Isometry3d& T_world_sensor, const TrackerConfig& config);

}  // namespace dynamic_icp::tracking
