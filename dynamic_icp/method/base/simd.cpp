// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/simd.hpp"

#include <array>
#include <cstddef>
#include <cstdlib>
#include <string_view>

namespace dynamic_icp::simd {
namespace {

constexpr std::array<Level, 2> kLevels = {Level::kBaseline, Level::kAvx2};

std::size_t levels_of_machine() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") ? 2 : 1;
#else
  return 1;
#endif
}

Level chosen_level() {
  const char* wish = std::getenv("DYNAMIC_ICP_SIMD");
  return wish != nullptr && std::string_view(wish) == "baseline" ? Level::kBaseline : available_levels().back();
}

}  // namespace

std::span<const Level> available_levels() { return std::span(kLevels).first(levels_of_machine()); }

Level level() {
  static const Level chosen = chosen_level();
  return chosen;
}

}  // namespace dynamic_icp::simd
