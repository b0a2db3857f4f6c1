// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dynamic_icp/recording/runs/run_folder.hpp"
#include "dynamic_icp/tools/figures/run_context.hpp"

namespace dynamic_icp::report {

/// Lines of frames.jsonl, counted from 0, that one looks at first, the worst one first: those with ground truth by the
/// translation error of the motion into them; in a run without any, those that are lost, then those that are
/// degenerate. At most `most`.
std::vector<std::size_t> worst_frames(const runs::RunFiles& run, const std::optional<figures::RunTruth>& truth,
                                      std::size_t most);

}  // namespace dynamic_icp::report
