// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <string>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/pcd_read.hpp"

#include "fuzz/memory_file.hpp"

// Any bytes are read or refused with a DataError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dynamic_icp;
  try {
    const formats::PcdFile file(std::string(reinterpret_cast<const char*>(data), size), "input");
    for (const std::string& name : file.names()) {
      fuzz::must(formats::column_as_doubles(file.read(name)).size() == file.points());
    }
  } catch (const DataError&) {
  }
  return 0;
}
