// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "dynamic_icp/tools/benchmark/results.hpp"
#include "dynamic_icp/tools/benchmark/table.hpp"

namespace dynamic_icp::benchmark {

/// With what, where and on what the results were measured, for the caption of every table: version, preset, changed
/// settings, machine, threads of a run, the most runs at the same time, inputs, and what methods had to assume.
std::string setup_text(const BenchmarkResults& results);

/// The caption of a table as plain text, without that: for several tables that are shown together, with it once.
std::string own_caption(const Table& table, const BenchmarkResults& results);

}  // namespace dynamic_icp::benchmark
