// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/figures/run_folder.hpp"
#include "dynamic_icp/figures/scan_view.hpp"

namespace dynamic_icp::figures {

/// The ground truth of a run at the times of its frames.
struct RunTruth {
  std::vector<Eigen::Vector3d> positions;  ///< m, moved so that the first matched pose is the estimated one
  std::vector<double> speed;               ///< m/s, per frame; NaN where unknown
  std::vector<double> translation_error;   ///< m, of the motion from the frame before, per frame; NaN where unknown
  std::vector<double> rotation_error;      ///< degrees, the same
};

/// What figures show beyond the files of the run, read again from the recording and its ground truth.
struct RunContext {
  std::optional<RunTruth> truth;   ///< empty without ground truth
  std::optional<ScanView> scan;    ///< empty when the recording is gone
  std::vector<std::string> notes;  ///< what had to be left out and why, in sentences
};

/// Reads what it can; what is gone or broken is left out and stands in the notes. `frame` is the line of frames.jsonl,
/// counted from 0, to show as a scan; without it the one with most points on objects. Throws UsageError when the run
/// has no such frame.
RunContext read_context(const RunFiles& run, std::optional<std::size_t> frame = std::nullopt);

}  // namespace dynamic_icp::figures
