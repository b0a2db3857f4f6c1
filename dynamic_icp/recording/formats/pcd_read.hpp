// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/recording/formats/npy.hpp"
#include "dynamic_icp/recording/formats/pcd_header.hpp"

namespace dynamic_icp::formats {

/// A PCD file in memory: ascii, binary or binary_compressed, with fields of any type and count.
class PcdFile {
 public:
  /// Reads a file. Throws DataError naming file, place and what was expected: no PCD header, more points than the file
  /// has bytes for (before memory is taken for them), damaged or too much data. Points with numbers that are not finite
  /// stay: it is for the reader of a field to decide about them.
  explicit PcdFile(const std::filesystem::path& path);

  /// The same for the content of a file; `origin` is the file that messages name.
  PcdFile(std::string content, const std::filesystem::path& origin);

  [[nodiscard]] std::size_t points() const { return header_.points; }

  /// The names of the fields in the order of the file, without padding.
  [[nodiscard]] std::vector<std::string> names() const;

  /// The numbers of a field, of the shape (N,), or (N, count). Throws DataError when there is no field of that name.
  [[nodiscard]] NpyArray read(std::string_view name) const;

  /// What was odd but could be lived with; empty: nothing.
  [[nodiscard]] const std::string& warning() const { return warning_; }

 private:
  void read_data();
  void read_ascii();
  void read_binary();
  void unpack();
  [[noreturn]] void fail(std::string_view message) const;

  std::string origin_;
  std::string bytes_;  ///< the records one after the other, or field by field where the file was compressed
  PcdHeader header_;
  std::string warning_;
};

}  // namespace dynamic_icp::formats
