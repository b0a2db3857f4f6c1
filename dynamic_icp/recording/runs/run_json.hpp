// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "dynamic_icp/recording/runs/run_recording.hpp"

namespace dynamic_icp::runs {

/// The names, in the folder of the run, of files that may lie there or elsewhere; empty where they do.
struct FilesInRun {
  std::filesystem::path map;
  std::filesystem::path mcap;
  std::filesystem::path layout;  ///< beside the MCAP file
  std::filesystem::path kitti;
};

/// The content of run.json; `read_run_json` reads it.
std::string run_json(const Recording& recording, const RunSettings& settings, const datasets::Dataset& dataset,
                     const std::filesystem::path& ground_truth, const RunResult& result, const FilesInRun& in_run);

/// What must be the same for a run to be resumed, as JSON: for `difference` (checkpoint.hpp). The parts
/// that run.json has, too, are there under the same names.
std::string run_identity(const Recording& recording, const RunSettings& settings, const datasets::Dataset& dataset,
                         const std::filesystem::path& ground_truth);

}  // namespace dynamic_icp::runs
