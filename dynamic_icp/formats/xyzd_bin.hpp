// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "dynamic_icp/base/scan.hpp"

namespace dynamic_icp::formats {

/// Reads a file of 16-byte records: little-endian float32 x, y, z (m), Doppler (m/s). The stamp is left 0.
/// An empty file is an empty scan and bytes after the last whole record are left out, both with a warning in the
/// result. Throws DataError for files that cannot be read, and names what it is when it is a Git LFS pointer or an
/// archive instead of data.
RawScan read_xyzd(const std::filesystem::path& path);

}  // namespace dynamic_icp::formats
