// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/formats/xyzd_bin.hpp"

#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "dynamic_icp/base/error.hpp"
#include "dynamic_icp/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

constexpr std::size_t kRecordBytes = 16;

/// A little-endian float32, whatever the byte order of this machine.
double read_float32(const char* bytes) {
  std::uint32_t bits = 0;
  for (int k = 3; k >= 0; --k) {
    bits = bits << 8 | static_cast<unsigned char>(bytes[k]);
  }
  return static_cast<double>(std::bit_cast<float>(bits));
}

void refuse_other_kinds(const std::filesystem::path& path, const std::string& content) {
  if (content.starts_with("version https://git-lfs")) {
    throw DataError(
        fmt::format("{}: is a Git LFS pointer, not data; run 'git lfs pull' where it came from", path.string()));
  }
  if (content.starts_with("PK\x03\x04")) {
    throw DataError(fmt::format("{}: is a zip archive; unpack it first", path.string()));
  }
}

}  // namespace

RawScan read_xyzd(const std::filesystem::path& path) {
  const std::string content = read_whole_file(path);
  refuse_other_kinds(path, content);
  RawScan raw;
  const std::size_t records = content.size() / kRecordBytes;
  raw.points.resize(records);
  raw.doppler.resize(records);
  for (std::size_t i = 0; i < records; ++i) {
    const char* record = content.data() + i * kRecordBytes;
    raw.points[i] = {read_float32(record), read_float32(record + 4), read_float32(record + 8)};
    raw.doppler[i] = read_float32(record + 12);
  }
  if (content.empty()) {
    raw.warning = fmt::format("{}: empty file, taken as a scan without points", path.string());
  } else if (content.size() % kRecordBytes != 0) {
    raw.warning = fmt::format("{}: {} bytes after record {} are left out: the size {} is not a multiple of {} bytes",
                              path.string(), content.size() % kRecordBytes, records, content.size(), kRecordBytes);
  }
  return raw;
}

}  // namespace dynamic_icp::formats
