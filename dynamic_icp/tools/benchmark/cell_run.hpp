// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>

#include <sys/types.h>

#include "dynamic_icp/tools/benchmark/cell_plan.hpp"
#include "dynamic_icp/tools/benchmark/child_process.hpp"
#include "dynamic_icp/tools/benchmark/results.hpp"

// The life of a cell. Its folder holds run/ (the files of the run), messages.txt (what the run said) and cell.json
// (fingerprint and result). cell.json is removed before a run starts and appears whole after it, so it never stands
// beside files of another run, wherever the process is killed.
namespace dynamic_icp::benchmark {

/// The result of the last run of this cell, finished or not, when its fingerprint is the same.
std::optional<CellResult> ended_result(const std::filesystem::path& benchmark_folder, const CellPlan& plan);

/// The result of an earlier run of the same cell that finished, when its fingerprint is the same and its run is there.
std::optional<CellResult> saved_result(const std::filesystem::path& benchmark_folder, const CellPlan& plan);

/// Starts the run in a process of its own. Throws DataError when the machine does not let it.
pid_t start_cell(const std::filesystem::path& benchmark_folder, const std::filesystem::path& program,
                 const CellPlan& plan);

/// Reads what the ended run left, scores its objects, and saves the result. A run that failed or was killed, or that
/// left files which cannot be read, gives a result that is not finished and says why. Throws DataError only when the
/// result cannot be saved.
CellResult finish_cell(const std::filesystem::path& benchmark_folder, const CellPlan& plan, const EndedChild& child,
                       int jobs);

}  // namespace dynamic_icp::benchmark
