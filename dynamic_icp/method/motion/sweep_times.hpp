// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/base/scan.hpp"

namespace dynamic_icp::motion {

/// What is done about the time a scan takes.
struct SweepConfig {
  bool deskew = true;                   ///< off: every scan counts as taken at its stamp (ablation "no-deskew")
  double declared_duration_s = 0.0;     ///< where points have no times: the scan takes so long, column by column; 0: no
  bool declared_left_to_right = false;  ///< order of these columns; off: from right to left, azimuth growing
  bool declared_as_stored = false;      ///< point after point as they are stored instead, not column by column
  /// Where points have no times and none are declared: whoever has all of a recording may find out, and declare, how
  /// its scans were taken. The method itself does not look ahead.
  bool search = true;
};

ConfigFields fields(SweepConfig& config);

/// Times (s after the stamp) of points of a scan measured at an even rate. Column by column: the azimuth atan2(y, x)
/// from one end of the scan to the other is the time; the x axis must look into the scan, so that it does not reach
/// across the back. As stored: the number of the point is.
std::vector<double> declared_times(const VectorColumns& points, const SweepConfig& config);

/// Where the times of the points of a scan come from.
enum class SweepTimes { kNone, kInData, kDeclared };
constexpr SweepTimes last_of(SweepTimes /*any*/) { return SweepTimes::kDeclared; }

/// What was found and done about the time a scan takes.
struct SweepReport {
  SweepTimes times = SweepTimes::kNone;
  std::optional<double> duration_s;  ///< from the earliest point to the latest; empty without times
  bool deskewed = false;             ///< whether the method takes the motion during the scan out of it
};

/// What the scan itself says; nothing is done about it yet. Times that cannot be those of the scan do not count.
SweepReport sweep_in_data(const ScanView& raw);

/// What a method finds and does that undoes sweeps as configured.
SweepReport sweep_as_configured(const ScanView& raw, const SweepConfig& config);

/// The scan with the times that count: its own, declared ones, which are put into `times`, or none when no sweep is
/// deskewed. Refers to `raw` and `times`.
ScanView retimed(const ScanView& raw, const SweepConfig& config, std::vector<double>& times);

}  // namespace dynamic_icp::motion
