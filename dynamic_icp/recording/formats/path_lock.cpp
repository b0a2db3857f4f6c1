// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/path_lock.hpp"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::formats {
namespace {

constexpr std::chrono::seconds kLongestWait{30};
constexpr std::chrono::milliseconds kBetweenLooks{2};

/// A file behind a link is not opened, a folder is; network file systems lock only files that may be written.
int open_to_lock(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  return file >= 0 || (errno != EISDIR && errno != ELOOP) ? file
                                                          : ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

}  // namespace

PathLock::PathLock(const std::filesystem::path& path, Wait wait, Kind kind) : descriptor_(open_to_lock(path)) {
  if (descriptor_ < 0) {
    return;
  }
  const auto give_up = std::chrono::steady_clock::now() + kLongestWait;
  const int operation = (kind == Kind::kAlone ? LOCK_EX : LOCK_SH) | LOCK_NB;
  int result = ::flock(descriptor_, operation);
  while (result != 0 && errno == EWOULDBLOCK && wait == Wait::kYes && std::chrono::steady_clock::now() < give_up) {
    std::this_thread::sleep_for(kBetweenLooks);
    result = ::flock(descriptor_, operation);
  }
  if (result != 0) {
    taken_ = errno == EWOULDBLOCK;
    release();
  }
  if (taken_ && wait == Wait::kYes) {
    throw DataError(fmt::format("{}: another process has locked it", path.string()));
  }
}

bool PathLock::is_of(const std::filesystem::path& path) const {
  if (!held()) {
    return false;
  }
  struct stat own = {};
  struct stat there = {};
  if (::fstat(descriptor_, &own) == 0 && ::stat(path.c_str(), &there) == 0) {
    return own.st_dev == there.st_dev && own.st_ino == there.st_ino;
  }
  if (errno == ENOENT || errno == ENOTDIR) {
    return false;
  }
  throw DataError(fmt::format("{}: cannot read: {}", path.string(), std::strerror(errno)));
}

void PathLock::release() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
    descriptor_ = -1;
  }
}

}  // namespace dynamic_icp::formats
