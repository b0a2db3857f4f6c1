// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace dynamic_icp::formats {

/// A lock on a folder or file, whatever its name becomes. It ends with the process, however that ends.
class PathLock {
 public:
  enum class Wait { kNo, kYes };
  enum class Kind { kAlone, kWithOthers };  ///< with others that lock it so, too

  /// Throws DataError when it was to wait and another one holds the lock for longer than moving folders takes.
  explicit PathLock(const std::filesystem::path& path, Wait wait = Wait::kNo, Kind kind = Kind::kAlone);
  ~PathLock() { release(); }
  PathLock(const PathLock&) = delete;
  PathLock& operator=(const PathLock&) = delete;

  /// False when another one holds it, or where there is no such path or no locks.
  [[nodiscard]] bool held() const { return descriptor_ >= 0; }

  /// Another one holds it.
  [[nodiscard]] bool taken() const { return taken_; }

  /// Whether what was locked still has this name. Throws DataError where that cannot be known.
  [[nodiscard]] bool is_of(const std::filesystem::path& path) const;

  void release();

 private:
  int descriptor_ = -1;
  bool taken_ = false;
};

}  // namespace dynamic_icp::formats
