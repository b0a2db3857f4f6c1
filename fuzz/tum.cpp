// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/tum.hpp"

#include <string_view>

#include "dynamic_icp/method/base/error.hpp"

#include "fuzz/memory_file.hpp"

// Any bytes are read or refused with a DataError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dynamic_icp;
  try {
    const formats::Trajectory poses =
        formats::parse_tum({reinterpret_cast<const char*>(data), size}, "input").trajectory;
    const formats::Trajectory again = formats::parse_tum(formats::format_tum(poses, "again"), "again").trajectory;
    fuzz::must(again.size() == poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      fuzz::must(again[i].stamp == poses[i].stamp);
      fuzz::must(again[i].T_world_sensor.translation() == poses[i].T_world_sensor.translation());
    }
  } catch (const DataError&) {
  }
  return 0;
}
