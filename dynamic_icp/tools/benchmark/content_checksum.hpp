// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace dynamic_icp::benchmark {

/// A checksum of 64 bits, as fast as files can be read: tells what has changed, not what somebody has forged.
class Checksum {
 public:
  /// Texts that are added one after the other count as themselves, not as what they are together.
  void add(std::string_view bytes);
  void add(std::span<const double> numbers);

  /// The whole content; of a file that cannot be read, as much as can be.
  void add_file(const std::filesystem::path& path);

  /// 16 hexadecimal digits.
  [[nodiscard]] std::string text() const;

 private:
  void mix(std::uint64_t word);

  std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

/// The checksum of a file or of a folder: of the names and the whole content of all files in it and below, also behind
/// links to folders. Hidden files, pictures, which no recording is read from, and what lies in `except` are left out.
std::string content_checksum(const std::filesystem::path& path, const std::filesystem::path& except = {});

/// The sizes of the same files together.
std::uintmax_t content_bytes(const std::filesystem::path& path, const std::filesystem::path& except = {});

/// The checksum of a whole file. Throws DataError when it cannot be read.
std::string file_checksum(const std::filesystem::path& path);

}  // namespace dynamic_icp::benchmark
