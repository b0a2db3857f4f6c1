// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dynamic_icp::formats {

/// A kind of result and the files it may consist of, so that replacing one removes nothing else.
struct ResultKind {
  /// The file that every result of this kind holds, and that is written last: "run.json".
  std::string marker;
  /// The files that a result in this folder may hold, relative to it, '#' standing for one digit or more:
  /// "labels/#.bin". What only the result itself can tell is read from it.
  std::function<std::vector<std::string>(const std::filesystem::path& folder)> files;
  /// The file from which the writing of a partial result can go on; empty where none is written.
  std::string checkpoint = {};
};

/// Whether a file name is one of the pattern's. What a killed process left of such a file ("run.json.partial-123") is.
bool matches(std::string_view name, std::string_view pattern);

/// Something in the folder of a result that is no part of it: another file, a link, a folder for none of its files.
/// Nothing when there is none. Throws DataError when the folder cannot be read.
std::optional<std::filesystem::path> foreign_entry(const std::filesystem::path& folder, const ResultKind& kind);

}  // namespace dynamic_icp::formats
