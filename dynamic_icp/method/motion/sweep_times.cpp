// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/motion/sweep_times.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamic_icp/method/base/scan_limits.hpp"

namespace dynamic_icp::motion {
namespace {

bool uses_declared_times(const ScanView& raw, const SweepConfig& config) {
  return raw.times.empty() && config.declared_duration_s > 0.0;
}

std::vector<double> times_as_stored(std::size_t points, double duration_s) {
  const double step_s = duration_s / std::max(1.0, static_cast<double>(points) - 1.0);
  std::vector<double> times(points);
  for (std::size_t i = 0; i < points; ++i) {
    times[i] = static_cast<double>(i) * step_s;
  }
  return times;
}

}  // namespace

ConfigFields fields(SweepConfig& config) {
  return {
      {"deskew", &config.deskew, 0, 0, "", "deskew scans whose points have times"},
      {"declared_duration_s", &config.declared_duration_s, 0.0, 10.0, "s",
       "where points have no times: the scan takes so long, column by column at an even rate; 0: taken at its stamp"},
      {"declared_left_to_right", &config.declared_left_to_right, 0, 0, "",
       "these columns run from left to right; off: from right to left"},
      {"declared_as_stored", &config.declared_as_stored, 0, 0, "",
       "the scan takes so long point by point as they are stored, not column by column"},
      {"search", &config.search, 0, 0, "",
       "where points have no times and none are declared: find out from the Doppler how scans were taken (run)"},
  };
}

std::vector<double> declared_times(const VectorColumns& points, const SweepConfig& config) {
  if (config.declared_as_stored) {
    return times_as_stored(points.size(), config.declared_duration_s);
  }
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  std::vector<double> times;
  times.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double azimuth = std::atan2(points.y[i], points.x[i]);
    times.push_back(azimuth);
    if (std::isfinite(azimuth)) {
      low = std::min(low, azimuth);
      high = std::max(high, azimuth);
    }
  }
  const double width = high > low ? high - low : 1.0;
  for (double& time : times) {
    const double share = std::isfinite(time) ? (time - low) / width : 0.0;  // such points are dropped later
    time = config.declared_duration_s * (config.declared_left_to_right ? 1.0 - share : share);
  }
  return times;
}

SweepReport sweep_in_data(const ScanView& raw) {
  SweepReport report;
  report.times = raw.times.empty() ? SweepTimes::kNone : SweepTimes::kInData;
  const TimeWindow window = plausible_times(raw.times);
  std::optional<double> low;
  std::optional<double> high;
  for (std::size_t i = 0; i < raw.times.size(); ++i) {
    const double time_s = raw.times[i];
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

SweepReport sweep_as_configured(const ScanView& raw, const SweepConfig& config) {
  SweepReport report = sweep_in_data(raw);
  if (uses_declared_times(raw, config)) {
    report.times = SweepTimes::kDeclared;
    report.duration_s = config.declared_duration_s;
  }
  report.deskewed = config.deskew && report.duration_s.value_or(0.0) > 0.0;
  return report;
}

ScanView retimed(const ScanView& raw, const SweepConfig& config, std::vector<double>& times) {
  ScanView timed = raw;
  if (!config.deskew) {
    timed.times = {};
  } else if (uses_declared_times(raw, config)) {
    times = declared_times(raw.points, config);
    timed.times = times;
  }
  return timed;
}

}  // namespace dynamic_icp::motion
