// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/recording/bags/bag.hpp"
#include "dynamic_icp/recording/bags/file_bag.hpp"

namespace dynamic_icp::bags {

/// The parts of a recording that was written into several files as one bag.
std::unique_ptr<Bag> join_bags(std::string_view container, std::vector<std::unique_ptr<FileBag>> parts,
                               std::vector<std::string> notes);

/// Why these files are not the parts of one recording, in words; empty where they are: their topics are the same (one
/// holds all that there are) and one begins where the other ends.
std::string why_not_one(const std::vector<std::unique_ptr<FileBag>>& parts);

/// A bag each of whose messages is packed with Zstandard, as ROS 2 writes with "compression mode: message".
std::unique_ptr<Bag> unpacking_messages(std::unique_ptr<Bag> bag);

}  // namespace dynamic_icp::bags
