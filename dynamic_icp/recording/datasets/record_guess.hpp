// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "dynamic_icp/recording/formats/point_records.hpp"

namespace dynamic_icp::datasets {

// What the records of a file are, told by its content: its size is a multiple of theirs, and some 200 of them, from all
// over the file, hold what records of that layout can hold.

/// Whether content can be a file of such records. Never of an empty file.
bool looks_like(std::string_view content, const formats::RecordLayout& layout);

/// The first of the candidates that the content of the file looks like; none: nullptr. Throws DataError naming the file
/// when it cannot be read or is of a known other kind.
const formats::RecordLayout* guess_layout(const std::filesystem::path& file,
                                          std::span<const formats::RecordLayout* const> candidates);

/// What is known to lie around as *.bin but has no Doppler, or none of a LiDAR: a sentence for the user; empty:
/// neither.
std::string without_doppler(std::string_view content);

}  // namespace dynamic_icp::datasets
