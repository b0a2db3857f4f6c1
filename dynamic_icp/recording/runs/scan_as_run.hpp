// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/motion/sweep_motion.hpp"
#include "dynamic_icp/recording/runs/run_folder.hpp"

namespace dynamic_icp::runs {

/// A scan as the method of a run had it.
struct ScanAsRun {
  Scan scan;  ///< points where they would have been measured at the stamp, where the run took the sweep out of them
  std::optional<motion::SweepMotion> motion;  ///< during the scan; empty where the run took no sweep out of it or
                                              ///< states no twist
  bool is_deskewed = false;
};

/// A scan of the recording as the run had it in this frame: with the times of points that its configuration declares,
/// and deskewed by the twists of the run or, where its method states none, by its poses. Points farther than
/// `max_range_m` are left out.
ScanAsRun scan_as_run(const RunFiles& run, std::size_t frame, const RawScan& raw, double max_range_m,
                      const Workers& workers);

}  // namespace dynamic_icp::runs
