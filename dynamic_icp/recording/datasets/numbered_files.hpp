// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace dynamic_icp::datasets {

/// The last run of digits in a text; empty when there is none.
std::string_view last_digits(std::string_view text);

/// The files of a folder whose names end with `ending` (".bin", "_dop.npy"), ordered by the number in their names, as
/// an integer of any length: 2.bin comes before 10.bin. Files without a number are left out; hidden files too. Throws
/// DataError when the folder cannot be read or two files carry the same number.
std::vector<std::filesystem::path> numbered_files(const std::filesystem::path& folder, std::string_view ending);

}  // namespace dynamic_icp::datasets
