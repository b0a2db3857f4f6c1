// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/evaluation/object_error.hpp"
#include "dynamic_icp/recording/runs/run_folder.hpp"
#include "dynamic_icp/tools/drawing/svg.hpp"
#include "dynamic_icp/tools/drawing/theme.hpp"
#include "dynamic_icp/tools/figures/paper.hpp"
#include "dynamic_icp/tools/figures/shown_scan.hpp"

namespace dynamic_icp::figures {

/// Two scans of a run that follow each other, as the run saw them.
struct ScanPair {
  std::size_t source = 0;  ///< frame of the first scan; the target is the next one
  ShownScan source_scan;
  ShownScan target_scan;
  std::vector<evaluation::TrueObject> true_objects;  ///< of the source; empty where they are not known
};

/// Throws UsageError when the run has no frame after `source`, DataError as `read_scan` does. True objects are
/// read from objects.jsonl of a simulated recording.
ScanPair read_pair(const runs::RunFiles& run, const datasets::Dataset& recording, std::size_t source,
                   const Workers& workers);

/// The steps of the method on one pair from above: the measured Doppler; what the velocity filter tells to move;
/// objects with boxes and velocities, and the true ones; the points of the largest object, as they are and predicted,
/// beside the next scan; and both scans as they were aligned.
drawing::Svg step_figure(const runs::RunFiles& run, const ScanPair& pair, const drawing::Theme& theme,
                         Medium medium = Medium::kScreen);

}  // namespace dynamic_icp::figures
