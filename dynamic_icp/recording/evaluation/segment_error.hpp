// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dynamic_icp/recording/evaluation/association.hpp"

namespace dynamic_icp::evaluation {

/// The mean error of a number of segments; empty without segments.
struct SegmentMean {
  std::size_t count = 0;
  std::optional<double> translation_percent;
  std::optional<double> rotation_deg_per_100m;
};

struct SegmentLength {
  double length_m = 0.0;
  SegmentMean mean;
};

struct SegmentError {
  std::vector<SegmentLength> lengths;  ///< 100, 200, ..., 800 m
  SegmentMean all;                     ///< over all segments of all lengths, each counted once
};

/// Drift in the manner of the KITTI odometry benchmark. A segment starts at every tenth matched pose, for each length,
/// and ends at the first pose more than that length further along the reference. Its error is that of the motion from
/// start to end, divided by the length.
SegmentError segment_error(const Association& matched);

}  // namespace dynamic_icp::evaluation
