// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

namespace CLI {
class App;
}

namespace dynamic_icp::apps {

/// --start and --max-frames, which is also known as --max-scans and --frames. `what` says what is done to the scans:
/// "process", "convert".
void add_selection_options(CLI::App& command, const char* what, std::size_t& start,
                           std::optional<std::size_t>& max_frames);

}  // namespace dynamic_icp::apps
