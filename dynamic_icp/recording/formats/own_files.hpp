// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace dynamic_icp::formats {

/// Throws DataError naming the entry unless a path, and all that lies below it, belongs to the user who runs the
/// program and is a regular file or a folder. Before files are written on and trusted as the memory of this program: a
/// link would lead elsewhere, a pipe would wait for ever, and another user may have written anything. Some file systems
/// give all files to one user, whoever writes them: where an owner differs, a file is made in `folder` for a moment to
/// see whom it belongs to.
void refuse_foreign_files(const std::filesystem::path& path, const std::filesystem::path& folder);

}  // namespace dynamic_icp::formats
