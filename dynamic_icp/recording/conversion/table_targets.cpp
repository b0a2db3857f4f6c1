// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// The layouts whose columns have names and types: each holds the table of a scan as it is, or nearly so.

#include <fmt/format.h>

#include "dynamic_icp/recording/conversion/targets.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/npz.hpp"
#include "dynamic_icp/recording/formats/point_table.hpp"

namespace dynamic_icp::conversion {

void write_npz_scan(const std::filesystem::path& folder, const std::string& stem, const ScanToWrite& scan,
                    Notes& notes) {
  formats::write_bytes(folder / (stem + ".npz"), formats::npz_bytes(scan_table(scan, true, notes)));
}

void write_pcd_scan(const std::filesystem::path& folder, const std::string& stem, const ScanToWrite& scan,
                    Notes& notes) {
  formats::write_bytes(folder / (stem + ".pcd"), formats::pcd_bytes(scan_table(scan, false, notes)));
}

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
  formats::write_bytes(folder / (stem + ".ply"), formats::ply_bytes(table));
}

}  // namespace dynamic_icp::conversion
