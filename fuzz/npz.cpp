// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/npz.hpp"

#include <string>

#include "dynamic_icp/method/base/error.hpp"

#include "fuzz/memory_file.hpp"

// Any bytes are read or refused with a DataError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dynamic_icp;
  try {
    const fuzz::MemoryFile input(data, size);
    const formats::NpzFile file(input.path());
    for (const std::string& name : file.names()) {
      if (file.why_no_numbers(name).empty()) {
        (void)file.read(name);
      }
    }
  } catch (const DataError&) {
  }
  return 0;
}
