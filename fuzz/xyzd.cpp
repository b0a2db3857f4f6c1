// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/xyzd_bin.hpp"

#include "fuzz/memory_file.hpp"

// Any bytes are read, and written again, or refused with a DataError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dynamic_icp;
  try {
    const fuzz::MemoryFile input(data, size);
    const RawScan raw = formats::read_xyzd(input.path());
    fuzz::must(Scan::from_raw(raw).size() <= size / 16);
    const fuzz::MemoryFile written(data, 0);
    formats::write_xyzd(written.path(), raw);
    fuzz::must(formats::read_xyzd(written.path()).points.size() == raw.points.size());
  } catch (const DataError&) {
  }
  return 0;
}
