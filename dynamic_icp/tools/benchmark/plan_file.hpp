// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "dynamic_icp/tools/benchmark/cell_plan.hpp"
#include "dynamic_icp/tools/benchmark/results.hpp"

// plan.json: the cells of a benchmark as a file, for those who run them elsewhere and in any order, as workflow engines
// do:
//
//   {"program": {"version", "checksum"},
//    "cells": [{"sequence", "method", "ablation", "folder", "arguments", "fingerprint", "object_truth", "scans",
//               "bytes_per_scan"}]}
//
// Folders are relative to that of plan.json. `scans` and `bytes_per_scan` tell how much time and memory a cell needs.
namespace dynamic_icp::benchmark {

/// Name of the file in the folder of a benchmark.
inline constexpr const char* kPlanName = "plan.json";

/// Replaces `folder`/plan.json. Throws DataError when it cannot be written, and for names that are not UTF-8.
void write_plan(const std::filesystem::path& folder, const Program& program, const std::vector<CellPlan>& cells);

struct PlanFile {
  std::string version;   ///< of the program that planned
  std::string checksum;  ///< of its file
  std::vector<CellPlan> cells;
};

/// Throws DataError that names the file and what is missing or wrong, also for a cell whose folder is not below the
/// benchmark's.
PlanFile read_plan(const std::filesystem::path& folder);

/// The cell of this folder, relative to the benchmark's. Throws UsageError when there is none.
const CellPlan& find_cell(const PlanFile& plan, const std::filesystem::path& folder);

/// The results of all cells that were run, as they lie in their folders; one that says so for each of the others.
std::vector<CellResult> collect_results(const std::filesystem::path& folder, const PlanFile& plan);

}  // namespace dynamic_icp::benchmark
