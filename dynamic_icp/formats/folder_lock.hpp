// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace dynamic_icp::formats {

/// A lock on a folder, whatever its name becomes. It ends with the process, however that ends.
class FolderLock {
 public:
  enum class Wait { kNo, kYes };

  explicit FolderLock(const std::filesystem::path& folder, Wait wait = Wait::kNo);
  ~FolderLock() { release(); }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// False when another one holds it, or where there are no locks.
  [[nodiscard]] bool held() const { return descriptor_ >= 0; }

  /// Whether the folder that was locked still has this name.
  [[nodiscard]] bool is_of(const std::filesystem::path& folder) const;

  void release();

 private:
  int descriptor_ = -1;
};

}  // namespace dynamic_icp::formats
