// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/base/stamp.hpp"

namespace dynamic_icp::simulation {

/// When a sensor makes its scans, and what it says about that.
struct TimingConfig {
  double start_s = 0.0;
  double period_jitter_s = 0.0;
  double stamp_jitter_s = 0.0;
  double point_time_offset_s = 0.0;
  double missing_scan_rate = 0.0;
};

ConfigFields fields(TimingConfig& config);

/// The same sensor with perfect clocks; it still begins at its own time.
TimingConfig without_errors(TimingConfig config);

/// One scan of a sensor.
struct ScanTime {
  Stamp begin;           ///< when its first ray leaves, on the clock of the drive
  Stamp stamp;           ///< when that was, as the sensor says
  bool missing = false;  ///< the scan was lost
};

/// The times of the scan that is due at `nominal`; `scan` has the random numbers of the scan. Random times are whole
/// microseconds and shift a scan by at most 0.24 periods each, so that scans keep their order; none is before 0.
ScanTime scan_time(const TimingConfig& config, Stamp nominal, double period_s, const RandomSource& scan);

}  // namespace dynamic_icp::simulation
