// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT

#include <array>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/recording/datasets/layouts.hpp"

#include "fuzz/memory_file.hpp"

// Any bytes are read or refused with a DataError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dynamic_icp;
  try {
    // PCD, PLY, NPZ, a table of text or NPY as a recording of one scan, by the first byte.
    if (size == 0) {
      return 0;
    }
    const fuzz::MemoryFile input(data + 1, size - 1);
    constexpr std::array kOpen = {datasets::open_pcd, datasets::open_ply, datasets::open_npz, datasets::open_csv,
                                  datasets::open_npz};
    const std::size_t kind = static_cast<unsigned char>(data[0] - '0') % kOpen.size();
    const std::unique_ptr<datasets::Dataset> dataset =
        kOpen[kind](kind + 1 == kOpen.size() ? input.named("points.npy") : input.path(), {});
    const RawScan raw = dataset->scan(0);
    fuzz::must(Scan::from_raw(raw).size() <= raw.points.size());
    (void)dataset->columns(0);
  } catch (const DataError&) {
  }
  return 0;
}
