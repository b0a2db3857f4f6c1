// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "dynamic_icp/tools/report/page.hpp"

namespace dynamic_icp::report {

/// Frames that all runs of a page share among them: with more, each run shows so many of its frames, evenly spread.
inline constexpr std::size_t kMaxFramesCompared = 40'000;

/// The page of several runs side by side, those over the same recording in a group, also where it was read from two
/// containers; without scans. Runs that have a page of their own are linked, as seen from `html`, the page to be
/// written. Throws DataError when a folder is not that of a finished run.
PageContent comparison_report(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& html);

/// Whether a folder is that of a benchmark: it holds results.json.
bool is_benchmark_folder(const std::filesystem::path& folder);

/// The page of a benchmark: its tables and the runs of its cells, a group a sequence; without scans. Cells that failed
/// or whose run is gone stand in the notes. Links as above. Throws DataError when results.json is missing or damaged.
PageContent benchmark_report(const std::filesystem::path& folder, const std::filesystem::path& html);

}  // namespace dynamic_icp::report
