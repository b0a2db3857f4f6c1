// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT

#include "dynamic_icp/base/error.hpp"
#include "dynamic_icp/formats/aeva_bin.hpp"

#include "fuzz/memory_file.hpp"

// Any bytes are read or refused with a DataError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dynamic_icp;
  try {
    const fuzz::MemoryFile input(data, size);
    for (const auto kind : {formats::AevaRecordKind::kWithoutIntensity, formats::AevaRecordKind::kWithIntensity}) {
      const formats::AevaScan scan = formats::read_aeva(input.path(), kind);
      fuzz::must(Scan::from_raw(scan.raw).size() <= size / formats::record_bytes(kind));
    }
  } catch (const DataError&) {
  }
  return 0;
}
