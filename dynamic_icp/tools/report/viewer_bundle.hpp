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

}  // namespace dynamic_icp::report
