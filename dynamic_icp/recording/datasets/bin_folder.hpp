// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>

#include "dynamic_icp/recording/datasets/dataset.hpp"

namespace dynamic_icp::datasets {

/// A folder of *.bin files that nothing else was recognised by: `input` itself, or one named velodyne up to three
/// levels below it; empty when there is none.
std::filesystem::path find_bin_folder(const std::filesystem::path& input);

/// Its scans, in records of the layout that the content of the first looks like, which is said among the assumptions.
/// Throws DataError when it looks like none, and for scans of KITTI, which have no Doppler.
std::unique_ptr<Dataset> open_bin_folder(const std::filesystem::path& folder, const OpenOptions& options = {});

}  // namespace dynamic_icp::datasets
