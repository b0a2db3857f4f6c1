// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/range_image.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "dynamic_icp/method/base/simd.hpp"
#include "dynamic_icp/method/tracking/coordinates.hpp"

namespace dynamic_icp::tracking {
namespace {

constexpr std::size_t kBlock = Coordinates::kMaxPoints;  // of points
constexpr int kColumns = 720;
constexpr int kRows = 120;
constexpr double kSlopePerRow = 0.0175;  // a degree
constexpr double kBehind_m = 1.0;        // what is so much nearer is another thing
constexpr double kMinBehindShare = 0.5;  // of the rows of a mirror image lie behind the mirror
constexpr double kFewBeside = 0.2;       // mirrors show less than this share of what is seen of themselves
constexpr double kMin_m = 1e-12;         // nothing is divided by less

struct Cell {
  int column = 0;
  int row = 0;
};

/// A measure of the azimuth that grows with it from 0 to 4 in one turn, without an arc tangent.
DYNAMIC_ICP_INLINE double turn_measure(double x, double y) {
  const double sum = std::abs(x) + std::abs(y);
  const double a = y / (sum > kMin_m ? sum : kMin_m);
  const double right = y < 0.0 ? 4.0 + a : a;
  return x < 0.0 ? 2.0 - a : right;
}

DYNAMIC_ICP_INLINE Cell cell_of(double x, double y, double z) {
  const double across = std::sqrt(x * x + y * y);
  const double row = z / (across > kMin_m ? across : kMin_m) * (1.0 / kSlopePerRow) + 0.5 * kRows;
  const double not_above = row < kRows - 1.0 ? row : kRows - 1.0;
  const int column = static_cast<int>(turn_measure(x, y) * (0.25 * kColumns));
  return {column < kColumns ? column : kColumns - 1, static_cast<int>(not_above > 0.0 ? not_above : 0.0)};
}

Cell cell_of(const Eigen::Vector3d& point) { return cell_of(point.x(), point.y(), point.z()); }

std::size_t place(int column, int row) { return static_cast<std::size_t>(column * kRows + row); }

// The kernels keep what they sum up to themselves until the end: a store through a pointer could change anything else.

/// The places of `count` points in the image. Returns the part of it where they are.
RangeImage::Part find_places(const Coordinates& at, std::size_t count, std::uint32_t* places) {
  RangeImage::Part part;
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const std::size_t n = count;
    std::uint32_t* const place = places;
    int top = 0;
    int bottom = kRows;
    int first = kColumns;
    int last = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Cell cell = cell_of(at.x[i], at.y[i], at.z[i]);
      place[i] = static_cast<std::uint32_t>(cell.column * kRows + cell.row);
      top = std::max(top, cell.row);
      bottom = std::min(bottom, cell.row);
      first = std::min(first, cell.column);
      last = std::max(last, cell.column);
    }
    part = {bottom, top, first, last};
  });
  return part;
}

/// The squared ranges of `count` points, m^2.
void measure_squared(const Coordinates& at, std::size_t count, float* squared) {
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const std::size_t n = count;
    float* const result = squared;
    for (std::size_t i = 0; i < n; ++i) {
      result[i] = static_cast<float>(at.x[i] * at.x[i] + at.y[i] * at.y[i] + at.z[i] * at.z[i]);
    }
  });
}

/// From those of the deskewed points to those that were measured at other times (s), along these lines of sight.
void take_back_motion(const Coordinates& sight, const double* times, const Eigen::Vector3d& velocity_sensor,
                      std::size_t count, float* squared) {
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const std::size_t n = count;
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

double RangeImage::cell_width() { return 8.0 / kColumns; }  // where the measure grows most slowly, at 45 degrees

void RangeImage::draw(const Scan& scan, const Eigen::Vector3d& velocity_sensor, const Workers& workers) {
  const std::size_t rows = scan.size();
  nearest_squared_.assign(static_cast<std::size_t>(kColumns * kRows), std::numeric_limits<float>::infinity());
  constexpr std::size_t kRowsOfPatches = PatchBlock::kRows * PatchBlock::kPatches;
  patches_.resize(Workers::block_count(rows, kRowsOfPatches));
  places_.resize(rows);
  squared_.resize(rows);
  part_of_block_.resize(Workers::block_count(rows, kBlock));
  const auto draw_block = [&](std::size_t begin, std::size_t end) {
    const std::size_t count = end - begin;
    Coordinates at;
    at.take(&scan.points()[begin], count);
    measure_squared(at, count, &squared_[begin]);
    if (scan.has_times()) {
      at.take(&scan.directions()[begin], count);
      take_back_motion(at, &scan.times()[begin], velocity_sensor, count, &squared_[begin]);
    }
    part_of_block_[begin / kBlock] = find_places(at, count, &places_[begin]);
  };
  workers.for_blocks(rows, kRowsOfPatches,
                     [&](std::size_t patches, std::size_t patches_begin, std::size_t patches_end) {
                       patches_[patches].bound(scan, patches_begin, patches_end, 0.0);
                       for (std::size_t begin = patches_begin; begin < patches_end; begin += kBlock) {
                         draw_block(begin, std::min(begin + kBlock, patches_end));
                       }
                     });
  for (std::size_t row = 0; row < rows; ++row) {
    float& nearest = nearest_squared_[places_[row]];
    nearest = std::min(nearest, squared_[row]);
  }
  find_seen_columns();
  lowest_seen_ = kRows;
  highest_seen_ = 0;
  for (const Part& of_block : part_of_block_) {
    lowest_seen_ = std::min(lowest_seen_, of_block.lowest);
    highest_seen_ = std::max(highest_seen_, of_block.highest);
  }
}

void RangeImage::find_seen_columns() {
  column_seen_.resize(kColumns);
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    for (std::size_t column = 0; column < kColumns; ++column) {
      const float* const cells = &nearest_squared_[column * kRows];
      int seen = 0;
      for (std::size_t row = 0; row < kRows; ++row) {
        seen |= cells[row] < std::numeric_limits<float>::infinity() ? 1 : 0;
      }
      column_seen_[column] = static_cast<char>(seen);
    }
  });
}

/// Whether something nearer is seen in the direction of a row of the scan, and beside it to all sides.
bool RangeImage::is_behind(std::uint32_t row) const {
  const auto column = static_cast<int>(places_[row] / kRows);
  const int image_row = static_cast<int>(places_[row] % kRows);
  const double limit = std::sqrt(static_cast<double>(squared_[row])) - kBehind_m;
  const auto is_nearer = [&](int at_column, int at_row) {
    const std::size_t at = place((at_column + kColumns) % kColumns, std::clamp(at_row, 0, kRows - 1));
    return std::sqrt(static_cast<double>(nearest_squared_[at])) < limit;
  };
  return is_nearer(column, image_row) && is_nearer(column - 1, image_row) && is_nearer(column + 1, image_row) &&
         is_nearer(column, image_row - 1) && is_nearer(column, image_row + 1);
}

bool RangeImage::are_mirrored(std::span<const std::uint32_t> rows) const {
  const auto behind = std::count_if(rows.begin(), rows.end(), [&](std::uint32_t row) { return is_behind(row); });
  if (static_cast<double>(behind) <= kMinBehindShare * static_cast<double>(rows.size())) {
    return false;
  }
  std::bitset<kColumns * kRows> is_touched;
  int first = kColumns;
  int last = 0;
  for (const std::uint32_t row : rows) {
    is_touched[places_[row]] = true;
    first = std::min(first, static_cast<int>(places_[row] / kRows));
    last = std::max(last, static_cast<int>(places_[row] / kRows));
  }
  std::size_t all = 0;
  for (std::size_t block = 0; block < part_of_block_.size(); ++block) {
    if (part_of_block_[block].last_column < first || part_of_block_[block].first_column > last) {
      continue;
    }
    const std::size_t begin = block * kBlock;
    const auto places = std::span(places_).subspan(begin, std::min(kBlock, places_.size() - begin));
    all += static_cast<std::size_t>(
        std::count_if(places.begin(), places.end(), [&](std::uint32_t at) { return is_touched[at]; }));
  }
  return static_cast<double>(rows.size()) < kFewBeside * static_cast<double>(all);
}

bool RangeImage::is_above_all(const Eigen::Vector3d& point) const { return cell_of(point).row > highest_seen_; }

/// Whether something is seen in a column, or on both sides of it: lines of sight may be farther apart than columns.
bool RangeImage::is_in_view(int column) const {
  const auto sees = [&](int step) {
    return 0 != column_seen_[static_cast<std::size_t>((column + step + kColumns) % kColumns)];
  };
  return sees(0) || ((sees(-1) || sees(-2)) && (sees(1) || sees(2)));
}

bool RangeImage::hides(const Eigen::Vector3d& point, double clearance_m) const {
  const Cell cell = cell_of(point);
  if (column_seen_.empty() || !is_in_view(cell.column) || cell.row < lowest_seen_) {
    return true;
  }
  // Of two cells above each other the one that holds more of what is seen above the point: below may be the ground.
  const Cell above = cell_of(point + 0.5 * kSlopePerRow * point.head<2>().norm() * Eigen::Vector3d::UnitZ());
  return std::sqrt(nearest_squared_[place(cell.column, above.row)]) < point.norm() - clearance_m;
}

}  // namespace dynamic_icp::tracking
