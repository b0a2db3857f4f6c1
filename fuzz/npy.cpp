// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/npy.hpp"

#include <string_view>
#include <vector>

#include "dynamic_icp/method/base/error.hpp"

#include "fuzz/memory_file.hpp"

// Any bytes are read or refused with a DataError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dynamic_icp;
  try {
    const formats::NpyArray array = formats::parse_npy({reinterpret_cast<const char*>(data), size}, "input");
    fuzz::must(formats::parse_npy(formats::npy_bytes(array), "again").bytes == array.bytes);
    fuzz::must(formats::column_as_doubles(array).size() == formats::rows_of(array));
    (void)formats::column_as_integers(array);
    if (formats::size_of(array.type) < sizeof(double)) {  // all numbers are exact as double
      const std::vector<double> column = formats::column_as_doubles(array);
      fuzz::must(formats::array_of(array.type, {column.size()}, column).bytes.size() <= array.bytes.size());
    }
  } catch (const DataError&) {
  }
  return 0;
}
