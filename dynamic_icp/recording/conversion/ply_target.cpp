// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <span>

#include <fmt/format.h>

#include "dynamic_icp/recording/conversion/targets.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/ply.hpp"

namespace dynamic_icp::conversion {

void write_ply_scan(const std::filesystem::path& folder, const std::string& stem, const ScanToWrite& scan,
                    Notes& notes) {
  std::vector<formats::NamedArray> table = scan_table(scan, false, notes);
  for (formats::NamedArray& column : table) {
    if (column.array.type == formats::NpyType::kInt64) {
      // Read as a double from the recording, so that as a double it loses nothing.
      notes.add(fmt::format("column '{}' is written as float64: PLY has no integers of 64 bits", column.name));
      column.array = array_of(formats::NpyType::kFloat64, column.array.shape, formats::column_as_doubles(column.array));
    }
  }
  const std::string bytes = formats::ply_table_bytes(table);
  formats::write_bytes(folder / (stem + ".ply"), std::as_bytes(std::span(bytes)));
}

}  // namespace dynamic_icp::conversion
