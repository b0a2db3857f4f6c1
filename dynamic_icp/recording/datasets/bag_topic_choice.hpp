// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dynamic_icp/recording/bags/bag.hpp"
#include "dynamic_icp/recording/datasets/open_options.hpp"

namespace dynamic_icp::datasets {

/// The names of the topics of clouds to read: those that the options name, else the only one whose points have a
/// Doppler by the names of their fields; a choice that is not obvious is added to the assumptions. Throws UsageError
/// for topics that are not there, are no clouds or are named twice; UnclearInput, with the topics, where none or
/// several have a Doppler; DataError where there are no clouds.
std::vector<std::string> choose_topics(const bags::Bag& bag, const std::filesystem::path& path,
                                       const OpenOptions& options, std::vector<std::string>& assumptions);

}  // namespace dynamic_icp::datasets
