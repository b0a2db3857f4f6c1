// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "dynamic_icp/recording/runs/run_recording.hpp"

namespace dynamic_icp::runs {

/// The content of run.json; `read_run_json` reads it. `map_in_run`: the map's name in the folder of the run, empty
/// where it lies elsewhere.
std::string run_json(const Recording& recording, const RunSettings& settings, const datasets::Dataset& dataset,
                     const std::filesystem::path& ground_truth, const RunResult& result,
                     const std::filesystem::path& map_in_run);

}  // namespace dynamic_icp::runs
