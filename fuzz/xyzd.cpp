// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT

#include <stdexcept>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/xyzd_bin.hpp"

#include "fuzz/memory_file.hpp"

namespace {

/// Points that lack their Doppler are not written.
void refuse_to_write(dynamic_icp::RawScan raw, const std::filesystem::path& path) {
  using namespace dynamic_icp;
  raw.doppler.clear();
  bool is_refused = false;
  try {
    formats::write_xyzd(path, raw);
  } catch (const std::invalid_argument&) {
    is_refused = true;
  }
  fuzz::must(is_refused && formats::read_xyzd(path).points.size() == 1);  // what was there is there still
}

}  // namespace

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
    if (raw.points.size() == 1) {
      refuse_to_write(raw, written.path());
    }
  } catch (const DataError&) {
  }
  return 0;
}
