// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/unfinished.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

namespace dynamic_icp::formats {
namespace {

constexpr std::size_t kMaxAtOnce = 16;  // what has no place here is found and removed by the next writer
constexpr int kMaxPasses = 4;           // a folder that changes while it is read may skip entries
constexpr int kDeepest = 32;

std::array<std::atomic<char*>, kMaxAtOnce> unfinished_paths{};
static_assert(std::atomic<char*>::is_always_lock_free, "read in a signal handler");

void remove_entry(int parent, const char* name, int depth);

/// Removes what lies in a folder; whether something was there.
bool empty_folder(int folder, int depth) {
  alignas(dirent64) std::array<char, 4096> entries;
  bool found = false;
  ::lseek(folder, 0, SEEK_SET);
  for (ssize_t length = 0; (length = ::getdents64(folder, entries.data(), entries.size())) > 0;) {
    for (ssize_t at = 0; at < length;) {
      const auto* const entry = reinterpret_cast<const dirent64*>(entries.data() + at);
      at += entry->d_reclen;
      if (std::strcmp(entry->d_name, ".") != 0 && std::strcmp(entry->d_name, "..") != 0) {
        remove_entry(folder, entry->d_name, depth);
        found = true;
      }
    }
  }
  return found;
}

// std::filesystem allocates: not for a signal handler.
void remove_entry(int parent, const char* name, int depth) {
  if (::unlinkat(parent, name, 0) == 0 || errno != EISDIR || depth >= kDeepest) {
    return;
  }
  const int folder = ::openat(parent, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (folder < 0) {
    return;
  }
  for (int pass = 0; pass < kMaxPasses && empty_folder(folder, depth + 1); ++pass) {
  }
  ::close(folder);
  ::unlinkat(parent, name, AT_REMOVEDIR);
}

}  // namespace

Unfinished::Unfinished(const std::filesystem::path& path) : path_(::strdup(std::filesystem::absolute(path).c_str())) {
  for (std::atomic<char*>& place : unfinished_paths) {
    char* vacant = nullptr;
    if (place.compare_exchange_strong(vacant, path_)) {
      return;
    }
  }
}

Unfinished::~Unfinished() {
  for (std::atomic<char*>& place : unfinished_paths) {
    char* own = path_;
    place.compare_exchange_strong(own, nullptr);
  }
  std::free(path_);
}

void remove_unfinished() noexcept {
  for (std::atomic<char*>& place : unfinished_paths) {
    if (const char* const path = place.load()) {
      remove_entry(AT_FDCWD, path, 0);
    }
  }
}

}  // namespace dynamic_icp::formats
