// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// The layouts whose columns have names and types: each holds the table of a scan as it is, or nearly so.
#include <span>

#include <fmt/format.h>

#include "dynamic_icp/recording/conversion/targets.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/npz.hpp"
#include "dynamic_icp/recording/formats/pcd.hpp"
#include "dynamic_icp/recording/formats/ply.hpp"

namespace dynamic_icp::conversion {
namespace {

void write(const std::filesystem::path& path, const std::string& bytes) {
  formats::write_bytes(path, std::as_bytes(std::span(bytes)));
}

}  // namespace

void write_npz_scan(const std::filesystem::path& folder, const std::string& stem, const ScanToWrite& scan,
                    Notes& notes) {
  write(folder / (stem + ".npz"), formats::npz_bytes(scan_table(scan, true, notes)));
}

void write_pcd_scan(const std::filesystem::path& folder, const std::string& stem, const ScanToWrite& scan,
                    Notes& notes) {
  write(folder / (stem + ".pcd"), formats::pcd_table_bytes(scan_table(scan, false, notes)));
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
  write(folder / (stem + ".ply"), formats::ply_table_bytes(table));
}

}  // namespace dynamic_icp::conversion
