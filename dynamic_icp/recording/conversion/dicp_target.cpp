// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "dynamic_icp/recording/conversion/targets.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/xyzd_bin.hpp"

namespace dynamic_icp::conversion {
namespace {

void note_losses(const ScanToWrite& from, Notes& notes) {
  if (from.types.point() != formats::NpyType::kFloat32 || from.types.doppler() != formats::NpyType::kFloat32) {
    notes.add("points and Doppler are rounded to float32: dicp has no other numbers");
  }
  if (from.types.time_column() != TimeColumn::kNone && from.types.time_type() != formats::NpyType::kFloat32) {
    notes.add("the times of points are rounded to float32 seconds: dicp has no other numbers");
  }
  if (from.types.some_times_missing()) {
    notes.add("the times of points are left out: some scans have none");
  }
  if (!from.scan.directions.empty()) {
    notes.add(
        "the lines of sight are left out: dicp takes them from the origin to the points, which is wrong for points of "
        "several sensors");
  }
  for (const datasets::PointColumn& column : from.columns) {
    notes.add(fmt::format("column '{}' is left out: dicp has no place for it", column.name));
  }
}

}  // namespace

void write_dicp_scan(const std::filesystem::path& folder, const std::string& stem, const ScanToWrite& from,
                     Notes& notes) {
  note_losses(from, notes);
  formats::make_folder(folder / "point_clouds");
  formats::write_xyzd(folder / "point_clouds" / (stem + ".bin"), from.scan);
  if (from.types.time_column() != TimeColumn::kNone) {
    formats::make_folder(folder / "times");
    formats::write_values<float>(folder / "times" / (stem + ".bin"),
                                 std::vector<float>(from.scan.times.begin(), from.scan.times.end()));
  }
}

}  // namespace dynamic_icp::conversion
