// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace dynamic_icp::speed {

/// Runs `work` in a forked child, so that its memory is its own, and returns the text it made. An exception of the
/// child is thrown here as DataError with its message (UsageError stays one); so is a child that was killed. This
/// process must have no other threads.
std::string text_of_child(const std::function<std::string()>& work);

/// What a program writes to its standard output. Throws DataError when it cannot be run or fails.
std::string output_of_program(const std::filesystem::path& program, const std::string& argument);

}  // namespace dynamic_icp::speed
