// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/lazy_image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamic_icp/method/base/simd.hpp"

namespace dynamic_icp::tracking {
namespace {

constexpr std::size_t kRowsOfPatch = PatchBlock::kRows;

/// Points of a patch as they were seen.
struct SeenPatch {
  std::array<double, kRowsOfPatch> x;  ///< m
  std::array<double, kRowsOfPatch> y;
  std::array<double, kRowsOfPatch> z;
  std::size_t count = 0;
};

void take_seen(const Eigen::Vector3d* points, SeenPatch& patch) {
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const double* const p = points->data();
    const std::size_t n = patch.count;
    for (std::size_t i = 0; i < n; ++i) {
      patch.x[i] = p[3 * i];
      patch.y[i] = p[3 * i + 1];
      patch.z[i] = p[3 * i + 2];
    }
  });
}

// The kernels keep what they sum up to themselves until the end: a store through a pointer could change anything else.

/// The places of the points in the image. Returns the lowest and the highest row.
ImagePart find_places(const SeenPatch& at, std::uint32_t* places) {
  ImagePart part;
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const std::size_t n = at.count;
    std::uint32_t* const place = places;
    int top = 0;
    int bottom = kImageRows;
    for (std::size_t i = 0; i < n; ++i) {
      const ImageCell cell = image_cell(at.x[i], at.y[i], at.z[i]);
      place[i] = static_cast<std::uint32_t>(cell.column * kImageRows + cell.row);
      top = std::max(top, cell.row);
      bottom = std::min(bottom, cell.row);
    }
    part.lowest_row = bottom;
    part.highest_row = top;
  });
  return part;
}

/// The squared ranges of the points, m^2.
void measure_squared(const SeenPatch& at, float* squared) {
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const std::size_t n = at.count;
    float* const result = squared;
    for (std::size_t i = 0; i < n; ++i) {
      result[i] = static_cast<float>(at.x[i] * at.x[i] + at.y[i] * at.y[i] + at.z[i] * at.z[i]);
    }
  });
}

/// From those of the deskewed points to those that were measured at other times (s), along these lines of sight.
void take_back_motion(const SeenPatch& sight, const double* times, const Eigen::Vector3d& velocity_sensor,
                      float* squared) {
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const std::size_t n = sight.count;
    float* const result = squared;
    const double* const time = times;
    const double vx = velocity_sensor.x();
    const double vy = velocity_sensor.y();
    const double vz = velocity_sensor.z();
    for (std::size_t i = 0; i < n; ++i) {
      const double closing = time[i] * (sight.x[i] * vx + (sight.y[i] * vy + sight.z[i] * vz));
      const double range = std::sqrt(static_cast<double>(result[i])) - closing;
      const auto seen = static_cast<float>(range > 0.0 ? range : 0.0);
      result[i] = seen * seen;
    }
  });
}

}  // namespace

void LazyImage::begin(const Scan& scan, const ScanPatches& patches, const Eigen::Vector3d& velocity_sensor) {
  scan_ = &scan;
  velocity_sensor_ = velocity_sensor;
  rows_ = scan.size();
  parts_.reset(patches);
  nearest_squared_.assign(std::size_t{kImageColumns} * kImageRows, std::numeric_limits<float>::infinity());
  places_.resize(rows_);
  squared_.resize(rows_);
  for (auto& is_full : is_full_) {
    is_full.store(0, std::memory_order_relaxed);
  }
  for (auto& column : columns_) {
    column.store(Column::kUnknown, std::memory_order_relaxed);
  }
  lowest_ = kImageRows;
  highest_ = 0;
}

void LazyImage::draw_all() {
  const std::scoped_lock lock(mutex_);
  for (std::size_t patch = 0; patch < parts_.size(); ++patch) {
    if (!parts_.is_seen(patch)) {
      draw(patch);
    }
  }
}

void LazyImage::draw(std::size_t patch) {
  const std::size_t begin = patch * kRowsOfPatch;
  SeenPatch at;
  at.count = std::min(kRowsOfPatch, rows_ - begin);
  take_seen(&scan_->points()[begin], at);
  measure_squared(at, &squared_[begin]);
  if (scan_->has_times()) {
    take_seen(&scan_->directions()[begin], at);
    take_back_motion(at, &scan_->times()[begin], velocity_sensor_, &squared_[begin]);
  }
  const ImagePart part = find_places(at, &places_[begin]);
  for (std::size_t row = begin; row < begin + at.count; ++row) {
    float& nearest = nearest_squared_[places_[row]];
    nearest = std::min(nearest, squared_[row]);
  }
  lowest_.store(std::min(lowest_.load(std::memory_order_relaxed), part.lowest_row), std::memory_order_relaxed);
  highest_.store(std::max(highest_.load(std::memory_order_relaxed), part.highest_row), std::memory_order_relaxed);
  parts_.set_seen(patch);
}

/// Draws the patches that may have points in a part, one by one, until it is enough.
template <typename IsEnough>
void LazyImage::draw_until(const ImagePart& part, const IsEnough& is_enough) {
  if (is_enough()) {
    return;
  }
  for (const std::uint32_t patch : parts_.unseen_in(part)) {
    draw(patch);
    if (is_enough()) {
      return;
    }
  }
}

void LazyImage::draw_part(const ImagePart& part) {
  const std::scoped_lock lock(mutex_);
  draw_until(part, [] { return false; });
}

void LazyImage::fill(std::size_t tile) {
  const auto at = static_cast<int>(tile);
  const int column = at / kTilesAbove * kTileColumns;
  const int row = at % kTilesAbove * kTileRows;
  const std::scoped_lock lock(mutex_);
  draw_until({column, column + kTileColumns - 1, row, row + kTileRows - 1}, [] { return false; });
  is_full_[tile].store(1, std::memory_order_release);
}

bool LazyImage::has_drawn(int column) const {
  const float* const cells = &nearest_squared_[place_in_image(column, 0)];
  return std::any_of(cells, cells + kImageRows,
                     [](float squared) { return squared < std::numeric_limits<float>::infinity(); });
}

bool LazyImage::sees(int column) {
  std::atomic<Column>& known = columns_[static_cast<std::size_t>(column)];
  Column state = known.load(std::memory_order_relaxed);
  if (state == Column::kUnknown) {
    const std::scoped_lock lock(mutex_);
    draw_until({column, column, 0, kImageRows - 1}, [&] { return has_drawn(column); });
    state = has_drawn(column) ? Column::kSeen : Column::kEmpty;
    known.store(state, std::memory_order_relaxed);
  }
  return state == Column::kSeen;
}

bool LazyImage::is_below_all(int row) {
  const auto is_lower = [&] { return row < lowest_.load(std::memory_order_relaxed); };
  if (!is_lower()) {
    return false;
  }
  const std::scoped_lock lock(mutex_);
  draw_until({0, kImageColumns - 1, 0, row}, [&] { return !is_lower(); });
  return is_lower();
}

bool LazyImage::is_above_all(int row) {
  const auto is_higher = [&] { return row > highest_.load(std::memory_order_relaxed); };
  if (!is_higher()) {
    return false;
  }
  const std::scoped_lock lock(mutex_);
  draw_until({0, kImageColumns - 1, row, kImageRows - 1}, [&] { return !is_higher(); });
  return is_higher();
}

void LazyImage::draw_rows(std::span<const std::uint32_t> rows) {
  const std::scoped_lock lock(mutex_);
  for (const std::uint32_t row : rows) {
    if (const std::size_t patch = row / kRowsOfPatch; !parts_.is_seen(patch)) {
      draw(patch);
    }
  }
}

}  // namespace dynamic_icp::tracking
