// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "dynamic_icp/method/base/scan.hpp"

namespace dynamic_icp::formats {

// Scans in records of 16 bytes: little-endian float32 x, y, z (m, sensor frame), Doppler (m/s, positive away).

/// Reads such a file. The stamp is left 0. An empty file is an empty scan and bytes after the last whole record are
/// left out, both with a warning in the result. Throws DataError for files that cannot be read, and names what it is
/// when it is a Git LFS pointer or an archive instead of data.
RawScan read_xyzd(const std::filesystem::path& path);

/// Writes points and Doppler to a file of an output folder (see write_bytes). Throws std::invalid_argument when the
/// columns differ in length, DataError when the file cannot be written.
void write_xyzd(const std::filesystem::path& path, const RawScan& scan);

}  // namespace dynamic_icp::formats
