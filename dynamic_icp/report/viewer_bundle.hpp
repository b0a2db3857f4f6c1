// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>

namespace dynamic_icp::report {

/// The program that draws the page, made of viewer/ when it is built.
struct ViewerBundle {
  std::string_view script;  ///< an ES module without imports; never holds "</script"
  std::string_view style;   ///< CSS; never holds "</style"
};

/// Empty when the program was built without node and npm.
std::optional<ViewerBundle> viewer_bundle();

}  // namespace dynamic_icp::report
