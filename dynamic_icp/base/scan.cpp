// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/base/scan.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace dynamic_icp {
namespace {

void check_lengths(const RawScan& raw) {
  const std::size_t n = raw.points.size();
  const bool matching = raw.doppler.size() == n && (raw.times.empty() || raw.times.size() == n) &&
                        (raw.directions.empty() || raw.directions.size() == n);
  if (!matching) {
    throw std::invalid_argument("scan columns differ in length: " + std::to_string(n) + " points, " +
                                std::to_string(raw.doppler.size()) + " Doppler values, " +
                                std::to_string(raw.times.size()) + " times, " + std::to_string(raw.directions.size()) +
                                " directions");
  }
}

}  // namespace

Scan Scan::from_raw(const RawScan& raw, Dropped* dropped) {
  check_lengths(raw);
  Scan scan;
  Dropped counts;
  scan.stamp_ = raw.stamp;
  const std::size_t n = raw.points.size();
  scan.points_.reserve(n);
  scan.directions_.reserve(n);
  scan.doppler_.reserve(n);
  scan.times_.reserve(raw.times.size());
  scan.records_.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d& line_of_sight = raw.directions.empty() ? raw.points[i] : raw.directions[i];
    // stableNorm: coordinates beyond 1e154 must not turn into an infinite length unnoticed.
    const double length = line_of_sight.stableNorm();
    const bool finite = raw.points[i].allFinite() && std::isfinite(raw.doppler[i]) && std::isfinite(length) &&
                        (raw.times.empty() || std::isfinite(raw.times[i]));
    if (!finite) {
      ++counts.non_finite;
      continue;
    }
    if (length < 1e-12 || raw.points[i].isZero(0.0)) {
      ++counts.zero_range;
      continue;
    }
    scan.points_.push_back(raw.points[i]);
    scan.directions_.push_back(line_of_sight / length);
    scan.doppler_.push_back(raw.doppler[i]);
    if (!raw.times.empty()) {
      scan.times_.push_back(raw.times[i]);
    }
    scan.records_.push_back(static_cast<std::uint32_t>(i));
  }
  if (dropped != nullptr) {
    *dropped = counts;
  }
  return scan;
}

Scan Scan::select(std::span<const std::uint32_t> rows) const {
  Scan result;
  result.stamp_ = stamp_;
  result.points_.reserve(rows.size());
  result.directions_.reserve(rows.size());
  result.doppler_.reserve(rows.size());
  result.times_.reserve(has_times() ? rows.size() : 0);
  result.records_.reserve(rows.size());
  for (const std::uint32_t row : rows) {
    result.points_.push_back(points_[row]);
    result.directions_.push_back(directions_[row]);
    result.doppler_.push_back(doppler_[row]);
    if (has_times()) {
      result.times_.push_back(times_[row]);
    }
    result.records_.push_back(records_[row]);
  }
  return result;
}

void Scan::displace(std::size_t row, const Eigen::Vector3d& displacement) { points_[row] += displacement; }

}  // namespace dynamic_icp
