// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/motion/sweep_from_doppler.hpp"
#include "dynamic_icp/method/motion/sweep_times.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/datasets/scan_range.hpp"

namespace dynamic_icp::diagnosis {

/// How the scans of a recording without times of points were taken.
enum class SweepHypothesis {
  kUnknown,     ///< the Doppler does not show it
  kInstant,     ///< all points at once
  kAzimuthCcw,  ///< column by column, counter-clockwise as seen from above: from right to left
  kAzimuthCw,   ///< the other way round: from left to right
  kAsStored,    ///< point after point as they are stored
};

/// cannot_tell, instant, azimuth_ccw, azimuth_cw, as_stored.
std::string_view to_string(SweepHypothesis hypothesis);

/// What the Doppler of some stretches of a recording says of its sweeps.
struct SweepSearch {
  SweepHypothesis hypothesis = SweepHypothesis::kUnknown;
  double duration_s = 0.0;           ///< of a sweep; 0 where none was found
  double margin = 0.0;               ///< standard errors between what was measured and the limit to other hypotheses
  motion::SweepDuration by_azimuth;  ///< as measured; negative where clockwise
  motion::SweepDuration as_stored;   ///< as measured
  std::size_t scans = 0;             ///< looked at
  std::string sentence;              ///< for the user

  /// Whether there is a sweep to be declared.
  [[nodiscard]] bool found_sweep() const { return duration_s > 0.0; }
};

/// Declares the sweep that was found, if one was.
void declare(const SweepSearch& search, motion::SweepConfig& config);

/// The hypothesis that two measurements decide for. A sweep takes the period between scans where the measurement allows
/// it, and never longer. One below 0.4 of the period is not told from an instant.
SweepSearch judge_sweep(const motion::SweepDuration& by_azimuth, const motion::SweepDuration& as_stored,
                        double period_s);

/// Looks at up to four stretches of 20 scans or a few more, evenly spread over `scans`, until they decide. Nothing
/// where points have times, the Doppler is compensated, or there are too few scans or too long between them. Throws
/// what reading a scan throws. The same for any number of threads.
std::optional<SweepSearch> search_sweep(const datasets::Dataset& dataset, const datasets::ScanRange& scans,
                                        double period_s, const Workers& workers);

}  // namespace dynamic_icp::diagnosis
