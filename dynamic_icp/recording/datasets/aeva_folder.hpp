// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace dynamic_icp::datasets {

// What HeRCULES and HeLiPR share: scans of an Aeva sensor in LiDAR/Aeva/<stamp_ns>.bin and what lies beside them, in
// any spelling of upper and lower case.

/// The folder of a recording (the one that holds LiDAR/Aeva/*.bin): `input`, the only one up to three levels below it,
/// or the one above when `input` is the folder of the scans itself; empty when there is none. Throws DataError when
/// there are several.
std::filesystem::path find_aeva_folder(const std::filesystem::path& input);

/// Whether such a folder is of HeRCULES: it has PR_GT or Radar, or its first scan is of 2024 or later.
bool is_hercules(const std::filesystem::path& folder);

/// A file or folder of the recording; empty when there is none. Archives of one recording may have been unpacked into
/// folders of their own: what is not in `folder` is looked for in the one above and
/// in those beside it that hold no scans themselves.
std::filesystem::path find_part(const std::filesystem::path& folder, std::string_view name);

}  // namespace dynamic_icp::datasets
