// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "dynamic_icp/recording/bags/file_bag.hpp"

// What files are bags, and how one is opened, packed or not.
namespace dynamic_icp::bags {

/// "rosbag", "rosbag2" or "mcap" by the first bytes of a file, also of one that is packed with Zstandard; "rosbag" for
/// a ROS bag of an old version too; empty for anything else. Throws DataError where it cannot be read.
std::string_view container_of(const std::filesystem::path& file);

/// Whether the name is one of a bag: *.bag, *.mcap, *.db3, also with .zst, .zstd (packed) or .active (not closed).
bool has_bag_name(const std::filesystem::path& file);

/// Opens one file. What is packed is unpacked into a temporary file first, which is removed with the bag. Throws
/// DataError.
std::unique_ptr<FileBag> open_file(const std::filesystem::path& file);

/// Whether a folder has a metadata.yaml of ROS 2.
bool has_metadata(const std::filesystem::path& folder);

/// What metadata.yaml says of a bag of ROS 2.
struct Rosbag2Metadata {
  std::vector<std::filesystem::path> files;  ///< all of them there
  std::vector<std::filesystem::path> missing;
  bool packed_messages = false;
};

/// Throws DataError naming file and line where it says nothing sensible or names no file that is there.
Rosbag2Metadata read_metadata(const std::filesystem::path& folder);

}  // namespace dynamic_icp::bags
