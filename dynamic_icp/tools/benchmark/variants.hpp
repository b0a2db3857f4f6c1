// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dynamic_icp/tools/benchmark/number_cells.hpp"
#include "dynamic_icp/tools/benchmark/results.hpp"

namespace dynamic_icp::benchmark {

/// The method whose parts can be switched off.
inline constexpr const char* kOurMethod = "dynamic-icp";

/// A row of the paper: a method, or ours with a part switched off.
struct Variant {
  std::string method;
  std::string ablation;
  std::string label;
};

/// The methods that were run on any sequence: by the paper's names and in its order, then others by their own names.
std::vector<Variant> methods_run(const BenchmarkResults& results);

/// dynamic-icp with parts switched off and in full, as far as it was run, by the paper's names and in its order.
std::vector<Variant> ablations_run(const BenchmarkResults& results);

/// The result of a cell; null when there is none yet.
const CellResult* find_cell(const BenchmarkResults& results, const CellKey& key);

/// Which number of a result.
using Pick = std::function<std::optional<double>(const CellResult&)>;

/// That number of a cell, which may be null or have failed.
Number number_of(const CellResult* cell, const Pick& pick);

}  // namespace dynamic_icp::benchmark
