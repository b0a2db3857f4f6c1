// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/runs/run_folder.hpp"
#include "dynamic_icp/tools/figures/run_context.hpp"
#include "dynamic_icp/tools/figures/shown_scan.hpp"

namespace dynamic_icp::report {

/// How much of a recording goes into a page.
struct ScanChoice {
  std::size_t budget_bytes = 40'000'000;  ///< for scans and map, as they stand in the page
  std::vector<std::size_t> whole;         ///< frames whose scans are kept whole whatever they take, ascending
  bool choose_whole = true;               ///< besides, keep a few telling ones whole where the budget has room
};

/// A scan of the page.
struct KeptScan {
  std::size_t frame = 0;
  double dt_s = 0.0;       ///< to the next scan; of the last one to the one before
  std::size_t points = 0;  ///< in the page
  std::size_t of = 0;      ///< in the recording
  bool whole = false;      ///< all that can be shown: finite, and not farther than figures::kFarthestShown_m
  std::string blob;        ///< see scan_blob.hpp
};

struct KeptMap {
  std::size_t points = 0;
  double cell_m = 0.0;
  std::string blob;
};

struct RunScans {
  std::vector<KeptScan> scans;     ///< ascending
  std::optional<KeptMap> map;      ///< empty when the run tells no static points
  std::optional<KeptMap> traces;   ///< the same of all points that move, wherever they were; empty when none do
  std::vector<std::string> notes;  ///< what was left out
};

/// Reads the recording again, two scans in memory at a time, and thins it to the budget: first points, spread over
/// space, those on objects before others; where fewer than kMinPoints are left to a scan, scans as well. The result
/// does not depend on the number of threads. Throws UsageError when a frame of `choice.whole` does not exist, DataError
/// when the recording is not the one of the run.
RunScans keep_scans(const runs::RunFiles& run, const std::optional<figures::RunTruth>& truth,
                    const datasets::Dataset& recording, const ScanChoice& choice, const Workers& workers);

/// The rows of a scan to keep when there are too many: half of `count` may go to points on objects, kept before
/// others; all rows, in an order that compresses well, when there are no more than `count`.
std::vector<std::uint32_t> rows_to_keep(const figures::ShownScan& scan, std::size_t count);

}  // namespace dynamic_icp::report
