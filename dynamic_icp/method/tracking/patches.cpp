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

SoughtPlace place_of(const OrientedBox& box, const Eigen::Vector3d& drift, double turn_rps) {
  SoughtPlace place;
  place.centre = box.centre;
  place.drift = drift;
  place.half_length = 0.5 * box.size.x() * box.axes.col(0).head<2>();
  place.half_width = 0.5 * box.size.y() * box.axes.col(1).head<2>();
  place.reach_m = 0.5 * box.size.z() * box.axes.col(2).head<2>().norm();  // where it leans
  place.half_height_m = 0.5 * aligned_extent(box).z();
  place.turn_rps = turn_rps;
  return place;
}

void PatchBlock::bound(std::span<const Eigen::Vector3d> points, std::span<const double> times) {
  count_ = (points.size() + kRows - 1) / kRows;
  for (std::size_t patch = 0; patch < count_; ++patch) {
    const std::size_t row = patch * kRows;
    const std::size_t rows = std::min(kRows, points.size() - row);
    bound_points(patch, points.subspan(row, rows));
    time_[patch] = half_time_[patch] = latest_[patch] = farthest_[patch] = 0.0;
    if (!times.empty()) {
      bound_times(patch, times.subspan(row, rows));
    }
  }
}

void PatchBlock::bound_points(std::size_t patch, std::span<const Eigen::Vector3d> points) {
  const Eigen::Vector3d& middle = points[points.size() / 2];
  const double range = std::max(kMinRange_m, middle.head<2>().norm());
  const double ux = bounds_.x[patch] = middle.x() / range;
  const double uy = bounds_.y[patch] = middle.y() / range;
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
    along.take(bounds_.along_low[patch], bounds_.along_high[patch]);
    across.take(bounds_.across_low[patch], bounds_.across_high[patch]);
    upward.take(bounds_.low[patch], bounds_.high[patch]);
  });
}

void PatchBlock::bound_times(std::size_t patch, std::span<const double> times) {
  const Interval seconds = interval_around(times);
  time_[patch] = seconds.middle();
  half_time_[patch] = 0.5 * seconds.length();
  latest_[patch] = std::max(std::abs(seconds.low), std::abs(seconds.high));
  const Eigen::Vector3d farthest(std::max(std::abs(bounds_.along_low[patch]), std::abs(bounds_.along_high[patch])),
                                 std::max(std::abs(bounds_.across_low[patch]), std::abs(bounds_.across_high[patch])),
                                 std::max(std::abs(bounds_.low[patch]), std::abs(bounds_.high[patch])));
  farthest_[patch] = farthest.norm();
}

void PatchBlock::find(const SoughtPlace& place, Flags& may_hold) const {
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const std::size_t n = count_;
    const Eigen::Vector3d centre = place.centre;
    const Eigen::Vector3d drift = place.drift;
    const double drift_mps = drift.norm();
    const double reach = place.reach_m;
    const double half_height = place.half_height_m;
    const double turn_rps = place.turn_rps;
    const Eigen::Vector2d a = place.half_length;
    const Eigen::Vector2d b = place.half_width;
    Values apart;  // by which the farthest of the bounds is too far, m
    for (std::size_t i = 0; i < n; ++i) {
      const double x = centre.x() + time_[i] * drift.x();
      const double y = centre.y() + time_[i] * drift.y();
      const double z = centre.z() + time_[i] * drift.z();
      const double turned_rad = turn_rps * latest_[i];
      const double turned_m = turned_rad * (1.0 + 0.5 * turned_rad) * farthest_[i];
      const double slack = half_time_[i] * drift_mps + turned_m + kRoundingOfBounds_m;
      const double ux = bounds_.x[i];
      const double uy = bounds_.y[i];
      const double along = ux * x + uy * y;
      const double across = ux * y - uy * x;
      // How far the place reaches to both sides of its centre.
      const double long_half = std::abs(ux * a.x() + uy * a.y()) + std::abs(ux * b.x() + uy * b.y()) + reach;
      const double broad_half = std::abs(ux * a.y() - uy * a.x()) + std::abs(ux * b.y() - uy * b.x()) + reach;
      const double low_along = bounds_.along_low[i] - along;
      const double high_along = along - bounds_.along_high[i];
      const double low_across = bounds_.across_low[i] - across;
      const double high_across = across - bounds_.across_high[i];
      const double low = bounds_.low[i] - z;
      const double high = z - bounds_.high[i];
      const double before = (low_along > high_along ? low_along : high_along) - long_half;
      const double beside = (low_across > high_across ? low_across : high_across) - broad_half;
      const double above = (low > high ? low : high) - half_height;
      const double level = before > beside ? before : beside;
      apart[i] = (level > above ? level : above) - slack;
    }
    for (std::size_t i = 0; i < n; ++i) {
      may_hold[i] = apart[i] <= 0.0 ? 1 : 0;
    }
  });
}

void ScanPatches::bound(const Scan& scan, const Workers& workers) { bound(scan.points(), scan.times(), workers); }

void ScanPatches::bound_sights(const Scan& scan, const Workers& workers) { bound(scan.directions(), {}, workers); }

void ScanPatches::bound(std::span<const Eigen::Vector3d> points, std::span<const double> times,
                        const Workers& workers) {
  rows_ = points.size();
  blocks_.resize(Workers::block_count(rows_, PatchBlock::kBlock));
  workers.for_blocks(rows_, PatchBlock::kBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
    blocks_[block].bound(points.subspan(begin, end - begin), times.empty() ? times : times.subspan(begin, end - begin));
  });
}

void clear_near_rows(const Scan& scan, const ScanPatches& patches, double range_m,
                     std::vector<std::uint8_t>& is_moving) {
  const auto clear_around = [&](const Eigen::Vector3d& origin, const auto& is_of_sensor) {
    SoughtPlace place;
    place.centre = origin;
    place.reach_m = range_m;
    place.half_height_m = range_m;
    patches.visit(place, [&](std::size_t begin, std::size_t end) {
      visit_flagged(is_moving, begin, end, [&](std::size_t row) {
        if (is_of_sensor(row) && (scan.points()[row] - origin).squaredNorm() < range_m * range_m) {
          is_moving[row] = 0;
        }
      });
    });
  };
  if (!scan.is_of_rig()) {
    clear_around(Eigen::Vector3d::Zero(), [](std::size_t) { return true; });
    return;
  }
  for (std::size_t sensor = 0; sensor < scan.mountings().size(); ++sensor) {
    clear_around(scan.mountings()[sensor].translation(),
                 [&](std::size_t row) { return scan.channels().sensor[row] == sensor; });
  }
}

}  // namespace dynamic_icp::tracking
