// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace dynamic_icp::figures {

/// The style sheet of the report: the colours of `page_theme` for light and, where the reader prefers that, dark.
std::string page_style();

}  // namespace dynamic_icp::figures
