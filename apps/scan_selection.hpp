// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include "dynamic_icp/recording/datasets/dataset.hpp"

namespace CLI {
class App;
}

namespace dynamic_icp::apps {

/// The scans [begin, end) of a recording.
struct ScanSelection {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// --start and --max-frames. `what` says what is done to the scans: "process", "convert".
void add_selection_options(CLI::App& command, const char* what, std::size_t& start,
                           std::optional<std::size_t>& max_frames);

/// What --start and --max-frames select. Throws UsageError when the recording is shorter, DataError naming the scan
/// where stamps do not increase.
ScanSelection select_scans(const datasets::Dataset& dataset, std::size_t start, std::optional<std::size_t> max_frames);

}  // namespace dynamic_icp::apps
