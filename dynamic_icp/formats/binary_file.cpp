// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/formats/binary_file.hpp"

#include <cerrno>
#include <fstream>

#include <fmt/format.h>

#include "dynamic_icp/base/error.hpp"
#include "dynamic_icp/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* action) {
  throw DataError(fmt::format("{}: cannot {}: {}", path.string(), action, std::strerror(errno)));
}

}  // namespace

void write_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  if (!file) {
    fail(path, "create");
  }
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) {
    fail(path, "write");
  }
}

RecordFile read_record_file(const std::filesystem::path& path, std::size_t record_bytes) {
  RecordFile file;
  file.bytes = read_whole_file(path);
  refuse_lfs_pointer(path, file.bytes);
  if (file.bytes.starts_with("PK\x03\x04")) {
    throw DataError(fmt::format("{}: is a zip archive; unpack it first", path.string()));
  }
  file.records = file.bytes.size() / record_bytes;
  const std::size_t rest = file.bytes.size() % record_bytes;
  if (file.bytes.empty()) {
    file.warning = fmt::format("{}: empty file, taken as a scan without points", path.string());
  } else if (rest != 0) {
    file.warning = fmt::format("{}: {} bytes after record {} are left out: the size {} is not a multiple of {} bytes",
                               path.string(), rest, file.records, file.bytes.size(), record_bytes);
  }
  return file;
}

void refuse_lfs_pointer(const std::filesystem::path& path, std::string_view content) {
  if (content.starts_with("version https://git-lfs")) {
    throw DataError(
        fmt::format("{}: is a Git LFS pointer, not data; run 'git lfs pull' where it came from", path.string()));
  }
}

void make_folder(const std::filesystem::path& path) {
  std::error_code fault;
  std::filesystem::create_directories(path, fault);
  if (fault) {
    throw DataError(fmt::format("{}: cannot create: {}", path.string(), fault.message()));
  }
}

}  // namespace dynamic_icp::formats
