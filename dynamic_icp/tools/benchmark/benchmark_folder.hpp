// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "dynamic_icp/recording/formats/path_lock.hpp"

namespace dynamic_icp::benchmark {

/// A file that processes hold while they work in its folder.
class FolderLock {
 public:
  using Kind = formats::PathLock::Kind;

  /// Makes the file `name` in a folder that exists. Throws DataError when another process works there.
  FolderLock(const std::filesystem::path& folder, const char* name, Kind kind);

 private:
  formats::PathLock lock_;
};

/// The folder of a benchmark, held as long as the object lives: by this process alone, or by processes that each run
/// one of its cells.
class BenchmarkFolder {
 public:
  /// The folder must be new, empty or that of an earlier benchmark: it holds the file "benchmark.lock" then. Throws
  /// DataError for any other, and when another process works in it.
  explicit BenchmarkFolder(const std::filesystem::path& path, FolderLock::Kind kind = FolderLock::Kind::kAlone);

  /// Absolute.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  FolderLock lock_;
};

/// Whether the benchmark's own files have that name, so that no folder of runs can.
bool is_own_name(std::string_view name);

/// What is wrong with a name that a folder of runs is to have, as in "holds a slash"; empty: nothing.
std::string unfit_name(std::string_view name);

/// UTF-8 text with '_' for every control character: none reaches a terminal or breaks a table.
std::string without_control_characters(std::string_view text);

/// Removes files in `folder` that a killed process left half-written. Only for folders that no other process writes to.
void remove_partial_files(const std::filesystem::path& folder);

}  // namespace dynamic_icp::benchmark
