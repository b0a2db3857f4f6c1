// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "fuzz/bag.hpp"
#include "fuzz/memory_file.hpp"

// Any bytes are read or refused with a DataError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dynamic_icp::fuzz;
  const MemoryFile input(data, size);
  read_bag(input.path());
  return 0;
}
