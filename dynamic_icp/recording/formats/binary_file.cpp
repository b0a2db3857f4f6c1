// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/binary_file.hpp"

#include <cerrno>
#include <fstream>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"

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

void make_folder(const std::filesystem::path& path) {
  std::error_code fault;
  std::filesystem::create_directories(path, fault);
  if (fault) {
    throw DataError(fmt::format("{}: cannot create: {}", path.string(), fault.message()));
  }
}

}  // namespace dynamic_icp::formats
