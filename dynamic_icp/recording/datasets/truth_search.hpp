// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/stamp.hpp"
#include "dynamic_icp/recording/datasets/truth.hpp"

namespace dynamic_icp::datasets {

/// For layouts that do not say where their ground truth is (truth.hpp is for those that do).
///
/// Looks for trajectories in TUM's layout in `folder`, then in the folder above it: ref_poses.txt, ground_truth.txt,
/// gt.txt, poses.txt and *_gt.txt. One fits when at least half of the scans lie within 0.2 s of a pose, or, where the
/// stamps only count the scans (`stamps_are_indices`), when it has one pose for every scan. The only one that fits is
/// taken; which it is, or why none is, is added to the assumptions.
Truth search_truth(const std::filesystem::path& folder, const std::vector<Stamp>& stamps, bool stamps_are_indices,
                   std::vector<std::string>& assumptions);

}  // namespace dynamic_icp::datasets
