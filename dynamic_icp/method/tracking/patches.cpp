// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/patches.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "dynamic_icp/method/base/lanes.hpp"
#include "dynamic_icp/method/base/simd.hpp"
#include "dynamic_icp/method/tracking/coordinates.hpp"
#include "dynamic_icp/method/tracking/extremes.hpp"

namespace dynamic_icp::tracking {
namespace {

constexpr double kMinRange_m = 1e-6;
constexpr double kRoundingOfBounds_m = 0.01;  // more than rounding moves a point

}  // namespace

void PatchBlock::bound(const Scan& scan, std::size_t begin, std::size_t end, double turn_rps) {
  count_ = (end - begin + kRows - 1) / kRows;
  for (std::size_t patch = 0; patch < count_; ++patch) {
    const std::size_t row = begin + patch * kRows;
    const std::size_t rows = std::min(kRows, end - row);
    bound_points(patch, std::span(scan.points()).subspan(row, rows));
    time_[patch] = half_time_[patch] = turned_m_[patch] = 0.0;
    if (scan.has_times()) {
      bound_times(patch, std::span(scan.times()).subspan(row, rows), turn_rps);
    }
  }
}

void PatchBlock::bound_points(std::size_t patch, std::span<const Eigen::Vector3d> points) {
  const Eigen::Vector3d& middle = points[points.size() / 2];
  const double range = std::max(kMinRange_m, middle.head<2>().norm());
  const double ux = x_[patch] = middle.x() / range;
  const double uy = y_[patch] = middle.y() / range;
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const double* const p = points.data()->data();
    const std::size_t n = points.size();
    Extremes along(ux * p[0] + uy * p[1]);
    Extremes across(ux * p[1] - uy * p[0]);
    Extremes upward(p[2]);
    std::size_t i = 0;
    for (; i + simd::kLanes <= n; i += simd::kLanes) {
      simd::Lanes x, y, z;
      simd::load_columns(x, y, z, p + 3 * i);
      along.add(ux * x + uy * y);
      across.add(ux * y - uy * x);
      upward.add(z);
    }
    for (; i < n; ++i) {
      along.add(ux * p[3 * i] + uy * p[3 * i + 1]);
      across.add(ux * p[3 * i + 1] - uy * p[3 * i]);
      upward.add(p[3 * i + 2]);
    }
    along.take(along_low_[patch], along_high_[patch]);
    across.take(across_low_[patch], across_high_[patch]);
    upward.take(low_[patch], high_[patch]);
  });
}

void PatchBlock::bound_times(std::size_t patch, std::span<const double> times, double turn_rps) {
  const Interval seconds = interval_around(times);
  time_[patch] = seconds.middle();
  half_time_[patch] = 0.5 * seconds.length();
  if (turn_rps > 0.0) {
    const double turned_rad = turn_rps * std::max(std::abs(seconds.low), std::abs(seconds.high));
    const Eigen::Vector3d farthest(std::max(std::abs(along_low_[patch]), std::abs(along_high_[patch])),
                                   std::max(std::abs(across_low_[patch]), std::abs(across_high_[patch])),
                                   std::max(std::abs(low_[patch]), std::abs(high_[patch])));
    turned_m_[patch] = turned_rad * (1.0 + 0.5 * turned_rad) * farthest.norm();
  }
}

void PatchBlock::find(const SoughtPlace& place, Flags& may_hold) const {
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const std::size_t n = count_;
    const Eigen::Vector3d centre = place.centre;
    const Eigen::Vector3d drift = place.drift;
    const double drift_mps = drift.norm();
    const double reach = place.reach_m;
    const double half_height = place.half_height_m;
    Values apart;  // by which the farthest of the bounds is too far, m
    for (std::size_t i = 0; i < n; ++i) {
      const double x = centre.x() + time_[i] * drift.x();
      const double y = centre.y() + time_[i] * drift.y();
      const double z = centre.z() + time_[i] * drift.z();
      const double slack = half_time_[i] * drift_mps + turned_m_[i] + kRoundingOfBounds_m;
      const double along = x_[i] * x + y_[i] * y;
      const double across = x_[i] * y - y_[i] * x;
      const double before =
          along_low_[i] - along > along - along_high_[i] ? along_low_[i] - along : along - along_high_[i];
      const double beside =
          across_low_[i] - across > across - across_high_[i] ? across_low_[i] - across : across - across_high_[i];
      const double above = low_[i] - z > z - high_[i] ? low_[i] - z : z - high_[i];
      const double level = (before > beside ? before : beside) - reach;
      apart[i] = (level > above - half_height ? level : above - half_height) - slack;
    }
    for (std::size_t i = 0; i < n; ++i) {
      may_hold[i] = apart[i] <= 0.0 ? 1 : 0;
    }
  });
}

}  // namespace dynamic_icp::tracking
