// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace dynamic_icp::apps {

/// Makes tables/ and tables.md in the folder of a benchmark from its results.json and prints the tables. Throws
/// DataError when there are no results.
void write_tables(const std::filesystem::path& folder);

}  // namespace dynamic_icp::apps
