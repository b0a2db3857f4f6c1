// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace dynamic_icp::formats {

/// A file or folder under a temporary name. As long as this object lives, remove_unfinished() removes it.
class Unfinished {
 public:
  explicit Unfinished(const std::filesystem::path& path);
  ~Unfinished();
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;

 private:
  char* path_;
};

/// Removes all that is unfinished: for programs that are ended by a signal. Allocates nothing and takes no lock, so
/// that it may be called from a signal handler; nobody may write any more. Failures are ignored.
void remove_unfinished() noexcept;

}  // namespace dynamic_icp::formats
