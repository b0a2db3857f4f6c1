// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>

#include "dynamic_icp/recording/datasets/followed_dataset.hpp"

namespace dynamic_icp::datasets {

/// A folder of loose files that others are still put into. A file counts once a later one is there, or once nobody has
/// written to it for 150 ms.
std::unique_ptr<FollowedDataset> follow_folder(const std::filesystem::path& folder, const InputSettings& settings);

}  // namespace dynamic_icp::datasets
