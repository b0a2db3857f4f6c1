// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dynamic_icp/base/stamp.hpp"
#include "dynamic_icp/formats/trajectory.hpp"

namespace dynamic_icp::datasets {

/// The ground truth of a recording that does not name it.
struct FoundTruth {
  formats::Trajectory poses;   ///< empty: none was found
  std::filesystem::path file;  ///< the file they came from
};

/// Looks for trajectories in TUM's layout in `folder`, then in the folder above it: ref_poses.txt, ground_truth.txt,
/// gt.txt, poses.txt and *_gt.txt. One fits when at least half of the scans lie within 0.2 s of a pose, or, where the
/// stamps only count the scans (`stamps_are_indices`), when it has one pose for every scan. The only one that fits is
/// taken; which it is, or why none is, is added to the assumptions.
FoundTruth find_truth(const std::filesystem::path& folder, const std::vector<Stamp>& stamps, bool stamps_are_indices,
                      std::vector<std::string>& assumptions);

}  // namespace dynamic_icp::datasets
