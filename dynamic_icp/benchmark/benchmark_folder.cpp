// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/benchmark/benchmark_folder.hpp"

#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "dynamic_icp/base/error.hpp"
#include "dynamic_icp/formats/binary_file.hpp"

namespace dynamic_icp::benchmark {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLockName = "benchmark.lock";

void check_usable(const fs::path& path) {
  std::error_code fault;
  if (!fs::exists(path, fault)) {
    return;
  }
  if (!fs::is_directory(path, fault)) {
    throw DataError(fmt::format("{}: exists and is not a folder", path.string()));
  }
  if (!fs::exists(path / kLockName, fault) && !fs::is_empty(path, fault)) {
    throw DataError(
        fmt::format("{}: folder is not empty and holds no {}; choose another one", path.string(), kLockName));
  }
}

int open_locked(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) {
    throw DataError(fmt::format("{}: cannot create: {}", path.string(), std::strerror(errno)));
  }
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    const int reason = errno;
    ::close(descriptor);
    throw DataError(reason == EWOULDBLOCK
                        ? fmt::format("{}: another benchmark is running in this folder", path.parent_path().string())
                        : fmt::format("{}: cannot lock: {}", path.string(), std::strerror(reason)));
  }
  return descriptor;
}

}  // namespace

BenchmarkFolder::BenchmarkFolder(const fs::path& path) : path_(fs::absolute(path).lexically_normal()) {
  check_usable(path_);
  formats::make_folder(path_);
  lock_ = open_locked(path_ / kLockName);
  remove_partial_files(path_);
}

BenchmarkFolder::~BenchmarkFolder() { ::close(lock_); }

void remove_partial_files(const fs::path& folder) {
  std::error_code fault;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, fault)) {
    if (entry.path().filename().string().find(".partial-") != std::string::npos && entry.is_regular_file(fault)) {
      fs::remove(entry.path(), fault);
    }
  }
}

}  // namespace dynamic_icp::benchmark
