// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/recording/formats/npy_header.hpp"

namespace dynamic_icp::formats {

/// One property of all records of an element. Every type of the format fits a double exactly.
struct PlyColumn {
  std::string name;
  NpyType type = NpyType::kFloat32;  ///< in the file; of at most 32 bits where it is of integers
  bool is_list = false;
  std::vector<double> values;            ///< one per record; of lists one record's after the other's
  std::vector<std::size_t> list_begins;  ///< of lists only: where each record's values begin, and their end

  /// The values of one record of a list.
  [[nodiscard]] std::span<const double> list(std::size_t record) const;
};

/// A table of the file, e.g. "vertex" with the columns x, y, z.
struct PlyElement {
  std::string name;
  std::size_t count = 0;  ///< records
  std::vector<PlyColumn> columns;

  /// The column of that name; null when there is none.
  [[nodiscard]] const PlyColumn* find(std::string_view column) const;
};

struct PlyFile {
  std::vector<PlyElement> elements;

  /// The element of that name; null when there is none.
  [[nodiscard]] const PlyElement* find(std::string_view element) const;
};

/// Reads PLY 1.0: ascii, binary_little_endian or binary_big_endian. Floats may be infinite or not a number; it is for
/// the reader of a column to decide about them.
///
/// Throws DataError naming file, line (record in binary files) and what was expected: for headers that are none, for
/// more or fewer data than the header says, for values that are not of their type. Counts in the header are checked
/// against the size of the file before memory is taken: it is at most about eight times that of the file.
PlyFile read_ply(const std::filesystem::path& path);

/// The same for the content of a file; `origin` is the file that messages name.
PlyFile parse_ply(std::string_view content, const std::filesystem::path& origin);

}  // namespace dynamic_icp::formats
