// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/preprocess/declared_times.hpp"

namespace dynamic_icp::odometry {

/// Where the times of the points of a scan come from.
enum class SweepTimes { kNone, kInData, kDeclared };

/// What was found and done about the time a scan takes.
struct SweepReport {
  SweepTimes times = SweepTimes::kNone;
  std::optional<double> duration_s;  ///< from the earliest point to the latest; empty without times
  bool undone = false;               ///< whether the method takes the motion during the scan out of it
};

/// What the scan itself says; nothing is done about it yet. Times that cannot be those of the scan do not count.
SweepReport sweep_in_data(const RawScan& raw);

/// What a method finds and does that undoes sweeps as configured.
SweepReport sweep_as_configured(const RawScan& raw, const preprocess::SweepConfig& config);

/// The scan with the times that count, where these are not its own: declared ones, or none when no sweep is undone.
/// Nothing where the scan can be used as it is.
std::optional<RawScan> retimed(const RawScan& raw, const preprocess::SweepConfig& config);

}  // namespace dynamic_icp::odometry
