// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>

namespace dynamic_icp::report {

/// What makes a report page interactive (viewer/, bundled when this was built). Free of "</script" and "</style".
struct ViewerBundle {
  std::string_view script;
  std::string_view style;
};

/// Empty: built without node.
std::optional<ViewerBundle> viewer_bundle();

/// Likewise, of the page that shows a run while it goes on (live_page.hpp).
std::optional<ViewerBundle> live_bundle();

}  // namespace dynamic_icp::report
