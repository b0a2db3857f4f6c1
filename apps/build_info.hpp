// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace dynamic_icp::apps {

/// The commit that the program was built from, with "+" behind it where files were changed since; empty where it is not
/// known. Defined in a source that the build writes (cmake/commit.cmake).
std::string_view commit();

/// What `--version` prints: program and version, commit where it is known, compiler, vector instructions in force, and
/// what was built in.
std::string build_info();

}  // namespace dynamic_icp::apps
