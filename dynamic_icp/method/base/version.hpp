// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace dynamic_icp {

/// The version of the library, "major.minor.patch".
std::string_view version();

}  // namespace dynamic_icp
