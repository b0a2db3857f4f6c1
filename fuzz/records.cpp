// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/recording/datasets/record_guess.hpp"

#include "fuzz/memory_file.hpp"

// Any bytes are read as records of any layout, or refused with a DataError. The first byte chooses the layout, and what
// is read: points or one of the fields; after the last layout comes the guess, which looks at all of them.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dynamic_icp;
  using formats::RecordLayout;
  static const RecordLayout* const layouts[] = {&formats::kAeva25,   &formats::kAeva29,
                                                &formats::kBoreas40, &formats::kBoreas24,
                                                &formats::kBoreas28, &formats::kBoreas28BeamThenTime,
                                                &formats::kBoreas32, &formats::kXyzdTime,
                                                &formats::kXyzd,     &formats::kVod28};
  constexpr std::size_t kChoices = std::size(layouts) + 1;
  if (size == 0) {
    return 0;
  }
  const std::size_t choice = data[0] % kChoices;
  const std::size_t part = data[0] / kChoices;
  --size;
  try {
    const fuzz::MemoryFile input(data + 1, size);
    if (choice == std::size(layouts)) {
      static_cast<void>(datasets::guess_layout(input.path(), layouts));
      static_cast<void>(datasets::without_doppler({reinterpret_cast<const char*>(data) + 1, size}));
      return 0;
    }
    const RecordLayout& layout = *layouts[choice];
    if (part > 0 && part <= layout.fields.size()) {
      fuzz::must(formats::read_field(input.path(), layout, layout.fields[part - 1]).size() == size / layout.bytes);
      return 0;
    }
    const RawScan raw = formats::read_points(input.path(), layout);
    fuzz::must(raw.points.size() == size / layout.bytes);
    fuzz::must(Scan::from_raw(raw).size() <= raw.points.size());
  } catch (const DataError&) {
  }
  return 0;
}
