// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/sweep_report.hpp"

#include <algorithm>

#include "dynamic_icp/method/base/scan_limits.hpp"

namespace dynamic_icp::odometry {
namespace {

bool uses_declared_times(const RawScan& raw, const preprocess::SweepConfig& config) {
  return raw.times.empty() && config.declared_duration_s > 0.0;
}

}  // namespace

SweepReport sweep_in_data(const RawScan& raw) {
  SweepReport report;
  report.times = raw.times.empty() ? SweepTimes::kNone : SweepTimes::kInData;
  const TimeWindow window = plausible_times(raw.times);
  std::optional<double> low;
  std::optional<double> high;
  for (const double time_s : raw.times) {
    if (window.contains(time_s)) {
      low = std::min(low.value_or(time_s), time_s);
      high = std::max(high.value_or(time_s), time_s);
    }
  }
  if (low) {
    report.duration_s = *high - *low;
  }
  return report;
}

SweepReport sweep_as_configured(const RawScan& raw, const preprocess::SweepConfig& config) {
  SweepReport report = sweep_in_data(raw);
  if (uses_declared_times(raw, config)) {
    report.times = SweepTimes::kDeclared;
    report.duration_s = config.declared_duration_s;
  }
  report.undone = config.undo && report.duration_s.value_or(0.0) > 0.0;
  return report;
}

std::optional<RawScan> retimed(const RawScan& raw, const preprocess::SweepConfig& config) {
  if (!config.undo && !raw.times.empty()) {
    RawScan timeless = raw;
    timeless.times.clear();
    return timeless;
  }
  if (config.undo && uses_declared_times(raw, config)) {
    RawScan timed = raw;
    timed.times = preprocess::declared_times(raw.points, config);
    return timed;
  }
  return std::nullopt;
}

}  // namespace dynamic_icp::odometry
