// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Stands in for the source that viewer/build.mjs generates (cmake/viewer.cmake).
#include "dynamic_icp/tools/report/viewer_bundle.hpp"

namespace dynamic_icp::report {

std::optional<ViewerBundle> viewer_bundle() { return std::nullopt; }
std::optional<ViewerBundle> live_bundle() { return std::nullopt; }

}  // namespace dynamic_icp::report
