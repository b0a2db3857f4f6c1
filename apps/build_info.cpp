// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/build_info.hpp"

#include <fmt/format.h>

#include "dynamic_icp/method/base/simd.hpp"
#include "dynamic_icp/method/base/version.hpp"

#include "apps/commands.hpp"
#include "apps/svg_rendering.hpp"

namespace dynamic_icp::apps {
namespace {

#if defined(__clang__)
constexpr const char* kCompiler = __VERSION__;  // names itself
#else
constexpr const char* kCompiler = "GCC " __VERSION__;
#endif

}  // namespace

std::string build_info() {
  std::string text = fmt::format("dynamic-icp {}\n", version());
  if (!commit().empty()) {
    text += fmt::format("commit    {}\n", commit());
  }
  text += fmt::format("compiler  {}\n", kCompiler);
  text += fmt::format("SIMD      {}\n", simd::level() == simd::Level::kAvx2 ? "AVX2" : "baseline");
  text += fmt::format("features  reports {} interactive views, {}", has_viewer() ? "with" : "without",
                      renders_svg() ? "PNG and PDF pictures" : "no PNG or PDF pictures");
  return text;
}

}  // namespace dynamic_icp::apps
