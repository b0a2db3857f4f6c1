// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::datasets {

/// The input is not one recording: it is of no known layout, or holds several. One that is damaged is a recording all
/// the same; what is wrong with it is another DataError.
class NotARecording : public DataError {
 public:
  using DataError::DataError;
};

/// What stands in the way of an input of no known layout, as a sentence that begins with the name of a file: that it,
/// or the first such file in the folder, is an archive, a Git LFS pointer, a ROS bag from before version 2.0, an array
/// or table of something else or the like. Empty: nothing of it.
std::string known_obstacle(const std::filesystem::path& input);

/// What an input of no known layout is instead, to be put behind its name: ": it holds 20 *.dat". Empty: nobody knows.
std::string what_is_there(const std::filesystem::path& input);

}  // namespace dynamic_icp::datasets
