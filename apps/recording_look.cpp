// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/recording_look.hpp"

#include <algorithm>

namespace dynamic_icp::apps {
namespace {

constexpr std::size_t kScansLookedAt = 10;
constexpr double kGapPeriods = 1.5;

}  // namespace

TimesSeen look_at_times(const datasets::Dataset& dataset) {
  std::vector<double> periods;
  for (std::size_t i = 1; i < dataset.size(); ++i) {
    periods.push_back(seconds_between(dataset.stamp(i - 1), dataset.stamp(i)));
  }
  TimesSeen seen;
  seen.periods = periods.size();
  if (periods.empty()) {
    return seen;
  }
  std::vector<double> sorted = periods;
  std::sort(sorted.begin(), sorted.end());
  seen.period_s = sorted[sorted.size() / 2];
  seen.shortest_s = sorted.front();
  seen.longest_s = sorted.back();
  for (std::size_t i = 0; i < periods.size(); ++i) {
    if (periods[i] > kGapPeriods * seen.period_s) {
      seen.gaps.emplace_back(i + 1, periods[i]);
    }
  }
  return seen;
}

PointsSeen look_at_points(const datasets::Dataset& dataset) {
  PointsSeen seen;
  seen.scans = std::min(kScansLookedAt, dataset.size());
  for (std::size_t k = 0; k < seen.scans; ++k) {
    const std::size_t index = (2 * k + 1) * dataset.size() / (2 * seen.scans);
    const RawScan raw = dataset.scan(index);
    Scan::Dropped here;
    const Scan scan = Scan::from_raw(raw, &here);
    seen.sizes.push_back(raw.points.size());
    seen.dropped += here;
    seen.times = seen.times || scan.has_times();
    for (std::size_t i = 0; i < scan.size(); ++i) {
      seen.nearest_m = std::min(seen.nearest_m, scan.points()[i].norm());
      seen.farthest_m = std::max(seen.farthest_m, scan.points()[i].norm());
      seen.slowest_mps = std::min(seen.slowest_mps, scan.doppler()[i]);
      seen.fastest_mps = std::max(seen.fastest_mps, scan.doppler()[i]);
    }
    if (!raw.warning.empty()) {
      seen.warnings.push_back(raw.warning);
    }
    if (k == 0) {
      seen.mountings = raw.mountings;
      for (const datasets::PointColumn& column : dataset.columns(index)) {
        seen.columns.push_back(column.name);
      }
    }
  }
  std::sort(seen.sizes.begin(), seen.sizes.end());
  return seen;
}

}  // namespace dynamic_icp::apps
