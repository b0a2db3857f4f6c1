// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/range_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "dynamic_icp/method/base/simd.hpp"

namespace dynamic_icp::tracking {
namespace {

constexpr std::size_t kPixelBlock = 512;
constexpr int kColumns = 720;
constexpr int kRows = 120;
constexpr double kSlopePerRow = 0.0175;  // a degree
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

/// Of up to kPixelBlock points: the columns, the places in the image and the squared ranges (m^2). Returns the highest
/// row of the image among them.
int find_cells(std::span<const Eigen::Vector3d> points, std::uint16_t* columns, std::uint32_t* places, float* squared) {
  std::array<double, kPixelBlock> x;
  std::array<double, kPixelBlock> y;
  std::array<double, kPixelBlock> z;
  for (std::size_t i = 0; i < points.size(); ++i) {
    x[i] = points[i].x();
    y[i] = points[i].y();
    z[i] = points[i].z();
  }
  int highest = 0;
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Cell cell = cell_of(x[i], y[i], z[i]);
      columns[i] = static_cast<std::uint16_t>(cell.column);
      places[i] = static_cast<std::uint32_t>(cell.column * kRows + cell.row);
      highest = std::max(highest, cell.row);
      squared[i] = static_cast<float>(x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
    }
  });
  return highest;
}

}  // namespace

double RangeImage::cell_width() { return 8.0 / kColumns; }  // where the measure grows most slowly, at 45 degrees

void RangeImage::draw(const Scan& scan, const Eigen::Vector3d& velocity_sensor, const Workers& workers) {
  const std::size_t rows = scan.size();
  nearest_squared_.assign(static_cast<std::size_t>(kColumns * kRows), std::numeric_limits<float>::infinity());
  column_seen_.assign(kColumns, 0);
  columns_.resize(rows);
  places_.resize(rows);
  squared_.resize(rows);
  highest_of_block_.resize(Workers::block_count(rows, kPixelBlock));
  workers.for_blocks(rows, kPixelBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
    highest_of_block_[block] = find_cells(std::span(scan.points()).subspan(begin, end - begin), &columns_[begin],
                                          &places_[begin], &squared_[begin]);
  });
  if (scan.has_times()) {
    measured_columns_.resize(rows);
    workers.for_blocks(rows, kPixelBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
      std::array<float, kPixelBlock> unit;
      highest_of_block_[block] = find_cells(std::span(scan.directions()).subspan(begin, end - begin),
                                            &measured_columns_[begin], &places_[begin], unit.data());
      for (std::size_t row = begin; row < end; ++row) {
        const double closing = scan.times()[row] * scan.directions()[row].dot(velocity_sensor);
        const auto range = static_cast<float>(std::max(0.0, std::sqrt(static_cast<double>(squared_[row])) - closing));
        squared_[row] = range * range;
      }
    });
  }
  const std::vector<std::uint16_t>& measured = scan.has_times() ? measured_columns_ : columns_;
  for (std::size_t row = 0; row < rows; ++row) {
    float& nearest = nearest_squared_[places_[row]];
    if (squared_[row] < nearest) {  // of neighbours in one cell few are: a store each would make them wait for it
      nearest = squared_[row];
    }
    column_seen_[measured[row]] = 1;
  }
  highest_row_ = highest_of_block_.empty() ? 0 : *std::max_element(highest_of_block_.begin(), highest_of_block_.end());
}

int RangeImage::column_count() { return kColumns; }

RangeImage::ColumnRange RangeImage::columns_around(const Eigen::Vector3d& centre, double radius_m) {
  const double distance = std::sqrt(centre.x() * centre.x() + centre.y() * centre.y());
  if (radius_m >= 0.9 * distance) {
    return {0, kColumns};
  }
  // A radian is at most kColumns / 4 columns.
  const int half = static_cast<int>(std::ceil(std::asin(radius_m / distance) * (0.25 * kColumns))) + 1;
  return {(cell_of(centre).column - half + kColumns) % kColumns, std::min(kColumns, 2 * half + 1)};
}

bool RangeImage::is_above_all(const Eigen::Vector3d& point) const { return cell_of(point).row > highest_row_; }

bool RangeImage::hides(const Eigen::Vector3d& point, double clearance_m) const {
  const Cell cell = cell_of(point);
  bool column_seen = false;
  if (column_seen_.empty()) {
    return true;
  }
  for (const int step : {-1, 0, 1}) {
    column_seen =
        column_seen || 0 != column_seen_[static_cast<std::size_t>((cell.column + step + kColumns) % kColumns)];
  }
  if (!column_seen) {
    return true;
  }
  // Of two cells above each other the one that holds more of what is seen above the point: below may be the ground.
  const Cell above = cell_of(point + 0.5 * kSlopePerRow * point.head<2>().norm() * Eigen::Vector3d::UnitZ());
  return std::sqrt(nearest_squared_[place(cell.column, above.row)]) < point.norm() - clearance_m;
}

}  // namespace dynamic_icp::tracking
