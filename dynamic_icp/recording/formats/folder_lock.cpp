// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/folder_lock.hpp"

#include <cerrno>
#include <chrono>
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

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder, Wait wait)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0) {
    return;
  }
  const auto give_up = std::chrono::steady_clock::now() + kLongestWait;
  int result = ::flock(descriptor_, LOCK_EX | LOCK_NB);
  while (result != 0 && errno == EWOULDBLOCK && wait == Wait::kYes && std::chrono::steady_clock::now() < give_up) {
    std::this_thread::sleep_for(kBetweenLooks);
    result = ::flock(descriptor_, LOCK_EX | LOCK_NB);
  }
  if (result != 0) {
    taken_ = errno == EWOULDBLOCK;
    release();
  }
  if (taken_ && wait == Wait::kYes) {
    throw DataError(fmt::format("{}: another process has locked this folder", folder.string()));
  }
}

bool FolderLock::is_of(const std::filesystem::path& folder) const {
  struct stat own = {};
  struct stat there = {};
  return held() && ::fstat(descriptor_, &own) == 0 && ::stat(folder.c_str(), &there) == 0 &&
         own.st_dev == there.st_dev && own.st_ino == there.st_ino;
}

void FolderLock::release() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
    descriptor_ = -1;
  }
}

}  // namespace dynamic_icp::formats
