// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/mapping/map_alignment.hpp"

namespace dynamic_icp::mapping {

/// `align_to_map` from the best of several starts that are turned about each axis, as far as the prior leaves open:
/// for the first pair of scans, and when tracking was lost. The starts are compared with a part of the points.
MapAlignment search_and_align(const Scan& scan, const PlaneMap& map, const MotionPrior& prior,
                              const MapAlignConfig& config, const Workers& workers);

}  // namespace dynamic_icp::mapping
