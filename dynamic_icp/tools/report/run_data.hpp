// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "dynamic_icp/recording/runs/run_folder.hpp"
#include "dynamic_icp/tools/figures/run_context.hpp"
#include "dynamic_icp/tools/report/json_text.hpp"

namespace dynamic_icp::report {

/// An entry of "runs" (docs/report.md) without scans and map. With more than `max_frames` frames only so many, evenly
/// spread, go into its columns and plots.
Json run_data(const runs::RunFiles& run, const std::optional<figures::RunTruth>& truth, const std::string& name,
              std::size_t max_frames = static_cast<std::size_t>(-1));

}  // namespace dynamic_icp::report
