// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace dynamic_icp::formats {

/// Longer files of records are refused: no scan is that large, but a sparse file may be.
constexpr std::uintmax_t kMaxRecordFileBytes = std::uintmax_t{1} << 30U;

/// A file of records of equal size, read from front to back in blocks that fit the cache: faster than the whole file
/// at once or mapped into memory, and no harm comes of a file that is cut while it is read.
class RecordFile {
 public:
  /// Opens the file and looks at its first bytes. Throws DataError naming the file when it cannot be read, is longer
  /// than `max_bytes` or is known to be something else: an archive, a Git LFS pointer, a point cloud with a
  /// header.
  RecordFile(const std::filesystem::path& path, std::size_t record_bytes,
             std::uintmax_t max_bytes = kMaxRecordFileBytes);
  ~RecordFile();
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;

  /// How many whole ones there are.
  [[nodiscard]] std::size_t records() const { return bytes_ / record_bytes_; }

  [[nodiscard]] std::size_t bytes() const { return bytes_; }

  /// Of an empty file, and of bytes after the last whole record, which are left out; empty: nothing odd.
  [[nodiscard]] const std::string& warning() const { return warning_; }

  /// The next records, whole ones; empty after the last. Valid until the next call. Throws DataError naming the file
  /// and the place when they cannot be read.
  std::string_view next();

 private:
  void fill();

  std::filesystem::path path_;
  std::size_t record_bytes_;
  std::size_t bytes_ = 0;   ///< of the file
  std::size_t read_ = 0;    ///< of them, up to the end of the block
  std::size_t handed_ = 0;  ///< of them, to the caller
  std::string block_;
  std::string warning_;
  int descriptor_ = -1;
};

}  // namespace dynamic_icp::formats
