// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tracking/range_image.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace dynamic_icp::tracking {
namespace {

constexpr std::size_t kBlock = 4096;
constexpr int kColumns = 720;
constexpr int kRows = 120;
constexpr double kSlopePerRow = 0.0175;  // a degree

struct Cell {
  int column = 0;
  int row = 0;
};

/// A measure of the azimuth that grows with it from 0 to 4 in one turn, without an arc tangent.
double turn_measure(double x, double y) {
  const double a = y / std::max(std::abs(x) + std::abs(y), 1e-12);
  return x < 0.0 ? 2.0 - a : (y < 0.0 ? 4.0 + a : a);
}

Cell cell_of(const Eigen::Vector3d& point) {
  const double across = std::sqrt(point.x() * point.x() + point.y() * point.y());
  const double row = point.z() / std::max(across, 1e-12) / kSlopePerRow + 0.5 * kRows;
  const int column = static_cast<int>(turn_measure(point.x(), point.y()) * (0.25 * kColumns));
  return {std::min(column, kColumns - 1), static_cast<int>(std::clamp(row, 0.0, kRows - 1.0))};
}

std::size_t place(int column, int row) { return static_cast<std::size_t>(column * kRows + row); }

}  // namespace

double RangeImage::cell_width() { return 8.0 / kColumns; }  // where the measure grows most slowly, at 45 degrees

RangeImage::RangeImage(const Scan& scan, const Workers& workers)
    : nearest_squared_(static_cast<std::size_t>(kColumns * kRows), std::numeric_limits<float>::infinity()),
      column_seen_(kColumns, 0),
      columns_(scan.size()) {
  std::vector<std::uint32_t> places(scan.size());
  workers.for_each(scan.size(), kBlock, [&](std::size_t row) {
    const Cell cell = cell_of(scan.points()[row]);
    columns_[row] = static_cast<std::uint16_t>(cell.column);
    places[row] = static_cast<std::uint32_t>(place(cell.column, cell.row));
  });
  for (std::size_t row = 0; row < scan.size(); ++row) {
    float& nearest = nearest_squared_[places[row]];
    nearest = std::min(nearest, static_cast<float>(scan.points()[row].squaredNorm()));
    column_seen_[columns_[row]] = 1;
  }
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

bool RangeImage::hides(const Eigen::Vector3d& point, double clearance_m) const {
  const Cell cell = cell_of(point);
  bool column_seen = false;
  for (const int step : {-1, 0, 1}) {
    column_seen =
        column_seen || 0 != column_seen_[static_cast<std::size_t>((cell.column + step + kColumns) % kColumns)];
  }
  if (!column_seen) {
    return true;
  }
  float nearest = std::numeric_limits<float>::infinity();
  for (int row = std::max(0, cell.row - 1); row <= std::min(kRows - 1, cell.row + 1); ++row) {
    nearest = std::min(nearest, nearest_squared_[place(cell.column, row)]);
  }
  return std::sqrt(nearest) < point.norm() - clearance_m;
}

}  // namespace dynamic_icp::tracking
