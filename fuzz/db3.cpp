// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include "fuzz/bag.hpp"

// Any bytes are read or refused with a DataError. SQLite takes no file without a name.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::filesystem::path path = "/dev/shm/dynamic-icp-fuzz-" + std::to_string(::getpid()) + ".db3";
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  dynamic_icp::fuzz::read_bag(path);
  std::filesystem::remove(path);
  return 0;
}
