// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/aevascenes_sequence.hpp"

#include "fuzz/memory_file.hpp"

// Any bytes are read or refused with a DataError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dynamic_icp;
  try {
    const fuzz::MemoryFile input(data, size);
    const datasets::AevaScenesSequence sequence = datasets::read_aevascenes_sequence(input.path());
    fuzz::must(!sequence.frames.empty());
  } catch (const DataError&) {
  }
  return 0;
}
