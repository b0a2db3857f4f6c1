// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/ply.hpp"

#include <string_view>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/ply_values.hpp"

#include "fuzz/memory_file.hpp"

// Any bytes are read or refused with a DataError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dynamic_icp;
  try {
    const formats::PlyFile file = formats::parse_ply({reinterpret_cast<const char*>(data), size}, "input");
    for (const formats::PlyElement& element : file.elements) {
      for (const formats::PlyColumn& column : element.columns) {
        fuzz::must((column.is_list ? column.list_begins.size() - 1 : column.values.size()) == element.count);
        fuzz::must(!formats::ply_name(column.type).empty());
        for (std::size_t k = 0; column.is_list && k < element.count; ++k) {
          fuzz::must(column.list(k).size() <= column.values.size());
        }
      }
    }
  } catch (const DataError&) {
  }
  return 0;
}
