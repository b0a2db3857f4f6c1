// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/report/viewer_bundle.hpp"

namespace dynamic_icp::report {

std::optional<ViewerBundle> viewer_bundle() { return std::nullopt; }

}  // namespace dynamic_icp::report
