// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/timing.hpp"

#include <algorithm>
#include <cmath>

#include "dynamic_icp/tools/simulation/random_streams.hpp"

namespace dynamic_icp::simulation {
namespace {

constexpr double kMicroseconds = 1e6;  // in a second
constexpr double kMaxShift = 0.24;     // of a period: begin and stamp together keep the order of scans

/// A normal shift of at most `limit_s` in ns.
std::int64_t shift_ns(double sigma_s, double limit_s, double normal) {
  return 1000 * std::llround(kMicroseconds * std::clamp(sigma_s * normal, -limit_s, limit_s));
}

}  // namespace

ConfigFields fields(TimingConfig& config) {
  return {
      {"start_s", &config.start_s, 0.0, 10.0, "s", "the sensor begins each scan by this later than others of the rig"},
      {"period_jitter_s", &config.period_jitter_s, 0.0, 1.0, "s",
       "standard deviation of the begin of a scan; its stamp is right"},
      {"stamp_jitter_s", &config.stamp_jitter_s, 0.0, 1.0, "s", "standard deviation of the stamp from the begin"},
      {"point_time_offset_s", &config.point_time_offset_s, -1.0, 1.0, "s",
       "added to the times of the points after the stamp"},
      {"missing_scan_rate", &config.missing_scan_rate, 0.0, 0.9, "", "share of scans that are lost"},
  };
}

TimingConfig without_errors(TimingConfig config) {
  TimingConfig perfect;
  perfect.start_s = config.start_s;
  return perfect;
}

ScanTime scan_time(const TimingConfig& config, Stamp nominal, double period_s, const RandomSource& scan) {
  const double limit_s = kMaxShift * period_s;
  ScanTime time;
  time.begin.ns = nominal.ns + std::llround(1e9 * config.start_s);
  if (config.period_jitter_s > 0.0) {
    time.begin.ns += shift_ns(config.period_jitter_s, limit_s, scan.normal(kPeriodJitter));
  }
  time.stamp = time.begin;
  if (config.stamp_jitter_s > 0.0) {
    time.stamp.ns += shift_ns(config.stamp_jitter_s, limit_s, scan.normal(kStampJitter));
  }
  time.begin.ns = std::max<std::int64_t>(0, time.begin.ns);
  time.stamp.ns = std::max<std::int64_t>(0, time.stamp.ns);
  time.missing = config.missing_scan_rate > 0.0 && scan.uniform(kMissingScan) < config.missing_scan_rate;
  return time;
}

}  // namespace dynamic_icp::simulation
