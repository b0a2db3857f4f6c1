// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

namespace dynamic_icp::formats {

/// What lies in a folder, in any order. Throws DataError that names the folder where it cannot be read to its
/// end: the iterators of the standard library do not say where they failed.
std::vector<std::filesystem::directory_entry> entries_in(const std::filesystem::path& folder);

}  // namespace dynamic_icp::formats
