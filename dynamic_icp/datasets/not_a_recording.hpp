// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace dynamic_icp::datasets {

/// What stands in the way of an input of no known layout, as a sentence that begins with the name of a file: that it,
/// or the first such file in the folder, is an archive, a Git LFS pointer, a ROS bag or the like. Empty: nothing of it.
std::string known_obstacle(const std::filesystem::path& input);

}  // namespace dynamic_icp::datasets
