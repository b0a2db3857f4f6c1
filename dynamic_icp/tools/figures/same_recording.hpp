// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include "dynamic_icp/recording/runs/run_folder.hpp"

namespace dynamic_icp::figures {

/// Whether two runs are over the same recording: from the same path, or from two containers of it (say NPZ and MCAP).
/// Of those the scans of one number must begin at the same time after the first (to 1 ms) and have the same number of
/// points, in 95 of 100 scans at least; where all scans have the same number of points this tells nothing, and only the
/// path counts.
bool is_same_recording(const runs::RunFiles& a, const runs::RunFiles& b);

/// How far two runs over one recording are apart, over the scans that both have.
struct RunDifference {
  std::size_t scans = 0;
  double translation_m = 0.0;  ///< largest distance of two positions
  double rotation_deg = 0.0;   ///< largest angle between two orientations
};

/// Empty where they have no scan in common.
std::optional<RunDifference> difference(const runs::RunFiles& a, const runs::RunFiles& b);

}  // namespace dynamic_icp::figures
