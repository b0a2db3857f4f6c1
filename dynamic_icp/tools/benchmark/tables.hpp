// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "dynamic_icp/tools/benchmark/results.hpp"
#include "dynamic_icp/tools/benchmark/table.hpp"

// The paper's tables, made from saved results alone. A cell that failed shows as "failed", a number that does not
// exist as "-". Values count as equal when they look equal, and equal values stand out together. Nothing stands out
// where there is nothing to compare with. Captions state version, preset, machine, threads, jobs and inputs.
namespace dynamic_icp::benchmark {

/// (1) RTE and RRE per sequence and method, with their mean over the sequences. Methods are the rows as in the paper;
/// with more than six sequences these are the rows.
Table accuracy_table(const BenchmarkResults& results);
/// (2) Per sequence and method the mean NEES of rotation and of translation, and the share of scans with status ok
/// beyond four stated standard deviations (evaluation/consistency.hpp). No rows where no method states a covariance.
Table consistency_table(const BenchmarkResults& results);
/// (3) Mean iterations, convergence rate, frames per second, milliseconds p50 and p95, peak memory per method.
Table runtime_table(const BenchmarkResults& results);
/// (4) RTE and RRE per sequence with parts of dynamic-icp switched off.
Table ablation_table(const BenchmarkResults& results);
/// (5) Dyn./All max and mean, Clustered/Dyn., Refined/Dyn. of dynamic-icp per sequence.
Table dynamics_table(const BenchmarkResults& results);
/// (6) Object velocities of dynamic-icp against the truth per sequence, where there is truth.
Table objects_table(const BenchmarkResults& results);
/// (7) Its moving objects as tracks per sequence, where there is truth and boxes were reported.
Table tracks_table(const BenchmarkResults& results);

/// The names of all tables.
std::vector<std::string> table_names();

/// All tables that have rows, in this order.
std::vector<Table> all_tables(const BenchmarkResults& results);

}  // namespace dynamic_icp::benchmark
