// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/stamp.hpp"
#include "dynamic_icp/recording/datasets/scan_stamps.hpp"
#include "dynamic_icp/recording/datasets/truth.hpp"

namespace dynamic_icp::datasets {

/// Whether a file is named like a ground truth: ref_poses, ground_truth, groundtruth, gt, poses or *_gt, *_poses, as
/// .txt, .csv or .tum.
bool is_truth_name(const std::filesystem::path& file);

/// For layouts that do not say where their ground truth is (truth.hpp is for those that do).
///
/// Looks for files of poses (pose_file.hpp) in `folder`, then in the folder above it, by their names. One fits when at
/// least half of the scans lie within 0.2 s of a pose, or, where the stamps only count the scans
/// (`stamps_are_indices`), when it has one pose for every scan. The only one that fits is taken; which it is, or why
/// none is, is added to the assumptions.
Truth search_truth(const std::filesystem::path& folder, const std::vector<Stamp>& stamps, bool stamps_are_indices,
                   std::vector<std::string>& assumptions);

/// The same for scans whose names may only count them: then stamps of a ground truth that fits replace theirs, and what
/// was assumed of the period.
Truth take_truth(const std::filesystem::path& folder, StampedFiles& scans);

}  // namespace dynamic_icp::datasets
