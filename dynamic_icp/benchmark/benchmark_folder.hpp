// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace dynamic_icp::benchmark {

/// The folder of a benchmark, held by this process alone as long as the object lives. The lock ends with the process,
/// however that ends.
class BenchmarkFolder {
 public:
  /// The folder must be new, empty or that of an earlier benchmark: it holds the file "benchmark.lock" then. Throws
  /// DataError for any other, and when another process works in it.
  explicit BenchmarkFolder(const std::filesystem::path& path);
  ~BenchmarkFolder();
  BenchmarkFolder(const BenchmarkFolder&) = delete;
  BenchmarkFolder& operator=(const BenchmarkFolder&) = delete;

  /// Absolute.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int lock_ = -1;
};

/// Removes files in `folder` that a killed process left half-written. Only for folders that no other process writes to.
void remove_partial_files(const std::filesystem::path& folder);

}  // namespace dynamic_icp::benchmark
