// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/csv.hpp"

#include <string_view>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/recording/datasets/layouts.hpp"
#include "dynamic_icp/recording/datasets/pose_file.hpp"

#include "fuzz/memory_file.hpp"

namespace {

using namespace dynamic_icp;

void read_table(std::string_view text) {
  const formats::CsvTable table = formats::parse_csv(text, "input");
  fuzz::must(table.names.empty() || table.names.size() == table.columns.size());
  for (const formats::NpyArray& column : table.columns) {
    fuzz::must(formats::rows_of(column) == formats::rows_of(table.columns.front()));
  }
}

void read_scan_of(const std::filesystem::path& path) {
  const std::unique_ptr<datasets::Dataset> dataset = datasets::open_csv(path, {});
  const RawScan raw = dataset->scan(0);
  fuzz::must(Scan::from_raw(raw).size() <= raw.points.size());
  (void)dataset->columns(0);
}

void read_poses(const std::filesystem::path& path) {
  const datasets::PoseFile file = datasets::read_pose_file(path);
  fuzz::must(!file.poses.empty());
  for (std::size_t i = 1; i < file.poses.size(); ++i) {
    fuzz::must(!file.has_stamps || file.poses[i - 1].stamp < file.poses[i].stamp);
  }
  if (!file.has_stamps) {  // those of the scans are theirs
    const std::vector<Stamp> two = {Stamp{0}, Stamp{100'000'000}};
    fuzz::must(datasets::stamps_of(datasets::read_truth(path, two)) == two);
  }
}

}  // namespace

// Any text is a table, a scan or poses, as the first byte chooses, or refused with a DataError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const std::size_t kind = data[0] % 3;
  try {
    if (kind == 0) {
      read_table({reinterpret_cast<const char*>(data) + 1, size - 1});
      return 0;
    }
    const fuzz::MemoryFile input(data + 1, size - 1);
    kind == 1 ? read_scan_of(input.path()) : read_poses(input.path());
  } catch (const DataError&) {
  }
  return 0;
}
