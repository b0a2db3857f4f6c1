// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/recording/datasets/record_guess.hpp"

#include "fuzz/memory_file.hpp"

// Any bytes are read as records of any layout, or refused with a DataError; the guess looks at all of them.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dynamic_icp;
  using formats::RecordLayout;
  static const RecordLayout* const layouts[] = {&formats::kAeva25,   &formats::kAeva29,
                                                &formats::kBoreas40, &formats::kBoreas24,
                                                &formats::kBoreas28, &formats::kBoreas28BeamThenTime,
                                                &formats::kBoreas32, &formats::kXyzdTime,
                                                &formats::kXyzd,     &formats::kVod28};
  try {
    const fuzz::MemoryFile input(data, size);
    for (const RecordLayout* layout : layouts) {
      const RawScan raw = formats::read_points(input.path(), *layout);
      fuzz::must(raw.points.size() == size / layout->bytes);
      fuzz::must(Scan::from_raw(raw).size() <= raw.points.size());
      for (const formats::RecordField& field : layout->fields) {
        fuzz::must(formats::read_field(input.path(), *layout, field).size() == raw.points.size());
      }
    }
    static_cast<void>(datasets::guess_layout(input.path(), layouts));
  } catch (const DataError&) {
  }
  return 0;
}
