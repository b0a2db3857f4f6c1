// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/ground_heights.hpp"

#include <algorithm>
#include <cmath>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/simd.hpp"
#include "dynamic_icp/method/tracking/memory.hpp"
#include "dynamic_icp/method/tracking/oriented_box.hpp"

namespace dynamic_icp::tracking {
namespace {

// Heights are sorted into bins in cells of the ground.
constexpr double kCell_m = 6.0;
constexpr int kMaxReach = 3;  // cells
constexpr double kBin_m = 0.05;
constexpr double kBump_m = 0.1;                  // the ground is so far from the plane ...
constexpr double kBend = 0.02;                   // ... and so much of the distance
constexpr double kHighest_m = 1.0;               // of the lowest point that is seen of an object above the ground ...
constexpr double kHighestHidden_m = 3.0;         // ... where something hides what is below ...
constexpr double kDeepest_m = 0.3;               // ... and below it
constexpr std::size_t kMaxGroundPoints = 16384;  // of a scan: more would not make heights better
constexpr std::uint32_t kMinBinPoints = 6;       // of the bin with most points and its neighbours

}  // namespace

void GroundHeights::begin(const Ground& ground, std::span<const Eigen::Vector3d> points, const ScanPatches& patches,
                          std::span<const std::uint8_t> is_moving, const Eigen::Isometry3d& T_world_sensor) {
  ground_ = ground;
  patches_ = nullptr;
  if (!ground.offset_m) {
    return;
  }
  sensor_world_ = T_world_sensor.translation();
  R_level_sensor_ = ground.level.transpose() * T_world_sensor.linear();
  plane_z_ = *ground.offset_m - ground.up().dot(sensor_world_);
  points_ = points;
  is_moving_ = is_moving;
  patches_ = &patches;
  stride_ = std::max<std::size_t>(1, points.size() / kMaxGroundPoints);
  refill(is_added_, patches.blocks().size() * PatchBlock::kPatches, std::uint8_t{0});
  is_full_.fill(0);
  cells_.fill({});
}

/// Adds what may lie in some cells.
void GroundHeights::fill(const CellRange& range) const {
  bool is_full = true;
  range.visit([&](std::size_t cell) {
    is_full &= is_full_[cell] != 0;
    is_full_[cell] = 1;
  });
  if (is_full) {
    return;
  }
  const Eigen::Vector3d low(range.first_column, range.first_row, -0.5 * kBins * kBin_m / kCell_m);
  const Eigen::Vector3d high(range.last_column + 1, range.last_row + 1, 0.5 * kBins * kBin_m / kCell_m);
  const Eigen::Vector3d corner(-0.5 * kCell_m * kCells, -0.5 * kCell_m * kCells, plane_z_);
  const Eigen::Matrix3d R_sensor_level = R_level_sensor_.transpose();
  const OrientedBox box{R_sensor_level * (corner + 0.5 * kCell_m * (low + high)), R_sensor_level,
                        kCell_m * (high - low)};
  // Patches lie far apart in memory: each is asked for while the one before is looked at.
  std::size_t waiting_begin = 0;
  std::size_t waiting_end = 0;
  patches_->visit(place_of(box, Eigen::Vector3d::Zero(), 0.0), [&](std::size_t begin, std::size_t end) {
    if (std::uint8_t& is_added = is_added_[begin / PatchBlock::kRows]; is_added == 0) {
      is_added = 1;
      for (std::size_t row = first_that_counts(begin); row < end; row += stride_) {
        __builtin_prefetch(&points_[row]);
      }
      add_patch(waiting_begin, waiting_end);
      waiting_begin = begin;
      waiting_end = end;
    }
  });
  add_patch(waiting_begin, waiting_end);
}

/// Adds the points of a patch that count.
void GroundHeights::add_patch(std::size_t begin, std::size_t end) const {
  const std::size_t first = first_that_counts(begin);
  if (first >= end) {
    return;
  }
  const std::size_t count = Workers::block_count(end - first, stride_);
  Bins bins;
  find_bins(first, count, bins);
  for (std::size_t i = 0; i < count; ++i) {
    if (bins.cell[i] >= 0 && is_moving_[first + i * stride_] == 0) {
      std::uint16_t& points_there =
          cells_[static_cast<std::size_t>(bins.cell[i])][static_cast<std::size_t>(bins.bin[i])];
      points_there = static_cast<std::uint16_t>(std::min(points_there + 1, 0xffff));
    }
  }
}

/// The bins of `count` points that count, from a row on.
void GroundHeights::find_bins(std::size_t begin, std::size_t count, Bins& bins) const {
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const Eigen::Matrix3d R = R_level_sensor_;
    const double* const p = points_[begin].data();
    const std::size_t step = 3 * stride_;
    const std::size_t n = count;
    const double ground_z = plane_z_;
    for (std::size_t i = 0; i < n; ++i) {
      const double x = p[i * step];
      const double y = p[i * step + 1];
      const double z = p[i * step + 2];
      const auto along = [&](int axis)
                             DYNAMIC_ICP_KERNEL { return (R(axis, 0) * x + R(axis, 1) * y) + R(axis, 2) * z; };
      const double bin = (along(2) - ground_z) / kBin_m + 0.5 * kBins;
      const double column = along(0) / kCell_m + 0.5 * kCells;
      const double row = along(1) / kCell_m + 0.5 * kCells;
      const bool is_inside =
          (bin >= 0.0) & (bin < kBins) & (column >= 0.0) & (column < kCells) & (row >= 0.0) & (row < kCells);
      const int cell = static_cast<int>(is_inside ? row : 0.0) * kCells + static_cast<int>(is_inside ? column : 0.0);
      bins.cell[i] = is_inside ? cell : -1;
      bins.bin[i] = static_cast<int>(is_inside ? bin : 0.0);
    }
  });
}

/// The cells nearest to a point, `reach` of them to each side; those that there are.
GroundHeights::CellRange GroundHeights::cells_around(const Eigen::Vector3d& point_world, int reach) const {
  const Eigen::Vector3d from_sensor = ground_.level.transpose() * (point_world - sensor_world_);
  const auto part = [](double value, int step) {
    const double cell = (value + kCell_m * (step + 0.5)) / kCell_m + 0.5 * kCells;
    return static_cast<int>(std::floor(std::clamp(cell, -1.0, 1.0 * kCells)));
  };
  const auto first = [&](double value) { return std::max(0, part(value, -reach)); };
  const auto last = [&](double value) { return std::min(kCells - 1, part(value, reach - 1)); };
  return {first(from_sensor.x()), last(from_sensor.x()), first(from_sensor.y()), last(from_sensor.y())};
}

Ground GroundHeights::below(const Eigen::Vector3d& lowest, bool is_hidden_below) const {
  Ground result = ground_;
  if (!ground_.offset_m) {
    return result;
  }
  const double farthest_m = kBump_m + kBend * (lowest - sensor_world_).norm();
  // The nearest four cells, and where nothing is seen of the ground there, more of them.
  for (int reach = 1; patches_ != nullptr && reach <= kMaxReach; ++reach) {
    const CellRange range = cells_around(lowest, reach);
    Histogram sum{};
    {
      const std::scoped_lock lock(mutex_);
      fill(range);
      range.visit([&](std::size_t cell) {
        for (std::size_t i = 0; i < sum.size(); ++i) {
          sum[i] = static_cast<std::uint16_t>(std::min(sum[i] + cells_[cell][i], 0xffff));
        }
      });
    }
    const auto allowed = static_cast<std::ptrdiff_t>(farthest_m / kBin_m);
    const auto low = sum.begin() + std::max<std::ptrdiff_t>(0, kBins / 2 - allowed);
    const auto high = sum.begin() + std::min<std::ptrdiff_t>(kBins, kBins / 2 + allowed);
    const auto most = static_cast<std::size_t>(std::max_element(low, high) - sum.begin());
    std::uint32_t count = 0;
    double height = 0.0;
    for (std::size_t i = most > 0 ? most - 1 : 0; i <= std::min(most + 1, sum.size() - 1); ++i) {
      count += sum[i];
      height += sum[i] * kBin_m * (static_cast<double>(i) + 0.5 - 0.5 * kBins);
    }
    if (count >= kMinBinPoints) {
      *result.offset_m += height / count;
      return result;
    }
  }
  const double height = ground_.up().dot(lowest) - *ground_.offset_m;
  const double above_m = height - (is_hidden_below ? kHighestHidden_m : kHighest_m);
  if (is_hidden_below && above_m >= 0.0 && above_m < farthest_m) {
    *result.offset_m += above_m;  // a slope, with a roof above it
  } else if (!(height > -kDeepest_m && above_m < 0.0)) {
    result.offset_m.reset();
  }
  return result;
}

}  // namespace dynamic_icp::tracking
