// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/own_files.hpp"

#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

/// Whether it is a folder.
bool check_entry(const fs::path& path) {
  struct stat status = {};
  if (::lstat(path.c_str(), &status) != 0) {
    throw DataError(fmt::format("{}: cannot read: {}", path.string(), std::strerror(errno)));
  }
  const bool is_folder = S_ISDIR(status.st_mode);
  if (!is_folder && !S_ISREG(status.st_mode)) {
    throw DataError(fmt::format("{}: is {}, expected a regular file or a folder", path.string(),
                                S_ISLNK(status.st_mode) ? "a link" : "a pipe, socket or device"));
  }
  if (status.st_uid != ::geteuid()) {
    throw DataError(fmt::format("{}: belongs to another user (uid {})", path.string(), status.st_uid));
  }
  return is_folder;
}

}  // namespace

void refuse_foreign_files(const fs::path& path) {
  if (!check_entry(path)) {
    return;
  }
  for (fs::recursive_directory_iterator entry(path); entry != fs::recursive_directory_iterator(); ++entry) {
    check_entry(entry->path());
  }
}

}  // namespace dynamic_icp::formats
