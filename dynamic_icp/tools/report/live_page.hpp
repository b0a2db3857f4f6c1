// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace dynamic_icp::report {

/// The page that shows a run while it goes on (docs/live.md): it listens to the server that it came from, and needs
/// nothing else. Empty where the viewer was not built (viewer_bundle.hpp).
std::string live_page();

}  // namespace dynamic_icp::report
