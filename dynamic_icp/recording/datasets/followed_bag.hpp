// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "dynamic_icp/recording/bags/followed_mcap.hpp"
#include "dynamic_icp/recording/datasets/followed_dataset.hpp"

namespace dynamic_icp::datasets {

/// The clouds of an MCAP file that comes bit by bit. It is opened once `first` clouds have come, with the topics,
/// fields and transforms that are known by then, and ends with the end mark of the file or of the stream. A stream that
/// is cut ends with what comes before; damage and a clock that goes back are errors once all scans before were handed
/// out.
///
/// `file` is where it can be read again at the end, for its ground truth; empty for a stream, which has none.
std::unique_ptr<FollowedDataset> follow_bag(std::unique_ptr<bags::FollowedMcap> mcap, const std::filesystem::path& file,
                                            const InputSettings& settings, std::size_t first);

}  // namespace dynamic_icp::datasets
