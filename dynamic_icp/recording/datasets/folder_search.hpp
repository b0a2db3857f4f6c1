// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

namespace dynamic_icp::datasets {

/// What lies in a folder and passes the test, in the order of names; nothing when the folder is not there or not ours
/// to read. Throws DataError when it cannot be read for another reason. Folders of scans are large: the entry knows its
/// type without asking the system again.
std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder,
                                              const std::function<bool(const std::filesystem::directory_entry&)>& test);

/// A folder, or a link to one, that is not hidden.
bool is_visible_folder(const std::filesystem::directory_entry& entry);

// Names are compared without regard to upper and lower case (of ASCII letters): releases of the same data set differ.

/// The absolute path without a slash at its end and without "." and "..", so that it has a name and a parent.
std::filesystem::path named_path(const std::filesystem::path& path);

bool same_name(const std::filesystem::path& path, std::string_view name);

/// The file or folder of that name in a folder, by way of folders with '/' ("LiDAR/Aeva"); empty when there is none. Of
/// several the one spelled so, else the first in the order of names.
std::filesystem::path child(const std::filesystem::path& folder, std::string_view name);

/// Whether it is a folder with at least one file of this extension (".bin") that is not hidden. Throws as entries_of
/// does.
bool holds_files(const std::filesystem::path& folder, std::string_view extension);

/// The only folder that is what is looked for, of `input` and those up to three levels below it; empty when there is
/// none. Below one that is there is no further search. Archives are often unpacked into a folder more than expected.
/// Throws NotARecording that lists them when there are several.
std::filesystem::path find_folder(const std::filesystem::path& input,
                                  const std::function<bool(const std::filesystem::path&)>& wanted);

}  // namespace dynamic_icp::datasets
