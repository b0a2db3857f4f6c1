// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/record_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/file_kind.hpp"

namespace dynamic_icp::formats {
namespace {

// Fits the second level of any cache beside the columns being written; larger ones were slower.
constexpr std::size_t kBlockBytes = 64 * 1024;

}  // namespace

RecordFile::RecordFile(const std::filesystem::path& path, std::size_t record_bytes, std::uintmax_t max_bytes)
    : path_(path), record_bytes_(record_bytes) {
  refuse_irregular(path);
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0 || S_ISDIR(status.st_mode)) {
    const int reason = descriptor_ >= 0 && S_ISDIR(status.st_mode) ? EISDIR : errno;
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
    throw DataError(fmt::format("{}: cannot open: {}", path.string(), std::strerror(reason)));
  }
  try {
    bytes_ = static_cast<std::size_t>(status.st_size);
    if (bytes_ > max_bytes) {
      throw DataError(fmt::format("{}: has {} bytes, expected at most {} of a scan", path.string(), bytes_, max_bytes));
    }
    fill();
    refuse_other_kind(path, block_, FileKind::kUnknown);
  } catch (const DataError&) {
    ::close(descriptor_);
    throw;
  }
  const std::size_t rest = bytes_ % record_bytes;
  if (bytes_ == 0) {
    warning_ = fmt::format("{}: empty file, taken as a scan without points", path.string());
  } else if (rest != 0) {
    warning_ = fmt::format("{}: {} bytes after record {} are left out: the size {} is not a multiple of {} bytes",
                           path.string(), rest, records(), bytes_, record_bytes);
  }
}

RecordFile::~RecordFile() { ::close(descriptor_); }

void RecordFile::fill() {
  const std::size_t room = std::max<std::size_t>(1, kBlockBytes / record_bytes_) * record_bytes_;
  block_.resize(std::min(room, bytes_ - read_));
  for (std::size_t used = 0; used < block_.size();) {
    const ssize_t got = ::read(descriptor_, block_.data() + used, block_.size() - used);
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got < 0) {
      throw DataError(fmt::format("{}: cannot read at byte {}: {}", path_.string(), read_, std::strerror(errno)));
    }
    if (got == 0) {
      throw DataError(fmt::format("{}: ends at byte {}, expected {} bytes: it was cut while being read", path_.string(),
                                  read_, bytes_));
    }
    used += static_cast<std::size_t>(got);
    read_ += static_cast<std::size_t>(got);
  }
}

std::string_view RecordFile::next() {
  if (handed_ == read_) {
    fill();
  }
  handed_ = read_;
  return std::string_view(block_).substr(0, block_.size() / record_bytes_ * record_bytes_);
}

}  // namespace dynamic_icp::formats
