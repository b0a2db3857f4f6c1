// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

#include "dynamic_icp/tools/benchmark/cell_plan.hpp"
#include "dynamic_icp/tools/benchmark/results.hpp"

namespace dynamic_icp::benchmark {

struct QueueOptions {
  std::filesystem::path folder;   ///< of the benchmark
  std::filesystem::path program;  ///< that runs a cell
  int jobs = 1;                   ///< cells at the same time, 1 or more
  bool repeat = false;            ///< runs finished cells again
};

/// Told as it happens; `plan` is the index of the cell.
struct QueueEvents {
  std::function<void(std::size_t plan)> started;
  std::function<void(std::size_t plan, const CellResult& result, bool saved)>
      ended;  ///< saved: by an earlier benchmark
};

/// Gives every planned cell a result: a saved one where there is one, all of these first; else by running it. A cell
/// that fails does not stop the others. Another cell is started beside a running one only while the machine has twice
/// the memory left that the largest cell so far took.
void run_cells(const std::vector<CellPlan>& plans, const QueueOptions& options, const QueueEvents& events);

}  // namespace dynamic_icp::benchmark
