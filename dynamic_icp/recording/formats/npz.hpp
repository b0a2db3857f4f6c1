// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/recording/formats/npy.hpp"

namespace dynamic_icp::formats {

// Named arrays of NumPy in one zip archive, as numpy.savez and numpy.savez_compressed write them.

// What is more is refused: no scan is that large, a damaged or hostile file may say so.
constexpr std::size_t kMaxNpzMemberBytes = std::size_t{1} << 28U;  ///< that a member unpacks to
constexpr std::size_t kMaxNpzBytes = std::size_t{1} << 29U;        ///< that those of an archive unpack to together
constexpr std::size_t kMaxNpzRows = std::size_t{1} << 25U;         ///< of an array

/// An archive open for reading.
class NpzFile {
 public:
  /// Throws DataError when the file cannot be read, is no zip archive or claims to unpack to more than kMaxNpzBytes in
  /// members that may be read.
  explicit NpzFile(const std::filesystem::path& path);
  ~NpzFile();
  NpzFile(const NpzFile&) = delete;
  NpzFile& operator=(const NpzFile&) = delete;

  /// The names of all arrays, also of those that hold no numbers, in the order of the archive.
  [[nodiscard]] std::vector<std::string> names() const;
  [[nodiscard]] bool contains(std::string_view name) const;

  /// Why the member of that name is no array of numbers, by its header: Python objects and tables are none, nor are
  /// types that are not read. A sentence that begins with the name; empty where it is one.
  [[nodiscard]] std::string why_no_numbers(std::string_view name) const;

  /// Unpacks one array. Throws DataError naming file and member when there is none of that name, it is damaged, claims
  /// more than kMaxNpzMemberBytes, has more than kMaxNpzRows or is not an array of numbers (see parse_npy). The other
  /// members stay readable.
  [[nodiscard]] NpyArray read(std::string_view name) const;

 private:
  class Archive;
  void refuse_bomb() const;
  [[nodiscard]] NpyArray unpacked(std::string_view name) const;

  std::filesystem::path path_;
  std::unique_ptr<Archive> archive_;
};

using NpzMember = NamedArray;

/// The bytes of an archive, not compressed: the same for the same arrays, whenever and wherever it is made. Throws
/// std::invalid_argument when there is no member or a name is empty or used twice.
std::string npz_bytes(std::span<const NpzMember> members);

/// Writes an archive whole or not at all.
void write_npz(const std::filesystem::path& path, std::span<const NpzMember> members);

}  // namespace dynamic_icp::formats
