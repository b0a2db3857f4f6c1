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

/// The coordinates of up to kPixelBlock points.
struct Coordinates {
  std::array<double, kPixelBlock> x;
  std::array<double, kPixelBlock> y;
  std::array<double, kPixelBlock> z;

  explicit Coordinates(std::span<const Eigen::Vector3d> points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      x[i] = points[i].x();
      y[i] = points[i].y();
      z[i] = points[i].z();
    }
  }
};

/// The places of `count` points in the image. Returns the highest row among them.
int find_places(const Coordinates& at, std::size_t count, std::uint32_t* places) {
  int highest = 0;
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    for (std::size_t i = 0; i < count; ++i) {
      const Cell cell = cell_of(at.x[i], at.y[i], at.z[i]);
      places[i] = static_cast<std::uint32_t>(cell.column * kRows + cell.row);
      highest = std::max(highest, cell.row);
    }
  });
  return highest;
}

/// The squared ranges of `count` points (m^2), and the boxes around each patch of them.
void measure(const Coordinates& at, std::size_t count, float* squared, RangeImage::Patch* patches) {
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    for (std::size_t i = 0; i < count; ++i) {
      squared[i] = static_cast<float>(at.x[i] * at.x[i] + at.y[i] * at.y[i] + at.z[i] * at.z[i]);
    }
  });
  for (std::size_t begin = 0; begin < count; begin += RangeImage::kPatch) {
    const std::size_t rows = std::min(RangeImage::kPatch, count - begin);
    const auto span_of = [&](const std::array<double, kPixelBlock>& values, double& low, double& high) {
      const Eigen::Map<const Eigen::ArrayXd> part(&values[begin], static_cast<Eigen::Index>(rows));
      low = part.minCoeff();
      high = part.maxCoeff();
    };
    RangeImage::Patch& patch = patches[begin / RangeImage::kPatch];
    span_of(at.x, patch.min().x(), patch.max().x());
    span_of(at.y, patch.min().y(), patch.max().y());
    span_of(at.z, patch.min().z(), patch.max().z());
  }
}

}  // namespace

double RangeImage::cell_width() { return 8.0 / kColumns; }  // where the measure grows most slowly, at 45 degrees

void RangeImage::draw(const Scan& scan, const Eigen::Vector3d& velocity_sensor, const Workers& workers) {
  const std::size_t rows = scan.size();
  nearest_squared_.assign(static_cast<std::size_t>(kColumns * kRows), std::numeric_limits<float>::infinity());
  column_seen_.assign(kColumns, 0);
  patches_.resize(Workers::block_count(rows, kPatch));
  places_.resize(rows);
  squared_.resize(rows);
  highest_of_block_.resize(Workers::block_count(rows, kPixelBlock));
  workers.for_blocks(rows, kPixelBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
    const Coordinates points(std::span(scan.points()).subspan(begin, end - begin));
    measure(points, end - begin, &squared_[begin], &patches_[begin / kPatch]);
    if (!scan.has_times()) {
      highest_of_block_[block] = find_places(points, end - begin, &places_[begin]);
      return;
    }
    const Coordinates directions(std::span(scan.directions()).subspan(begin, end - begin));
    highest_of_block_[block] = find_places(directions, end - begin, &places_[begin]);
    for (std::size_t row = begin; row < end; ++row) {
      const double closing = scan.times()[row] * scan.directions()[row].dot(velocity_sensor);
      const auto range = static_cast<float>(std::max(0.0, std::sqrt(static_cast<double>(squared_[row])) - closing));
      squared_[row] = range * range;
    }
  });
  for (std::size_t row = 0; row < rows; ++row) {
    float& nearest = nearest_squared_[places_[row]];
    nearest = std::min(nearest, squared_[row]);
    column_seen_[places_[row] / kRows] = 1;
  }
  highest_row_ = highest_of_block_.empty() ? 0 : *std::max_element(highest_of_block_.begin(), highest_of_block_.end());
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
  std::vector<bool> is_touched(nearest_squared_.size(), false);
  for (const std::uint32_t row : rows) {
    is_touched[places_[row]] = true;
  }
  const auto all = std::count_if(places_.begin(), places_.end(), [&](std::uint32_t at) { return is_touched[at]; });
  return static_cast<double>(rows.size()) < kFewBeside * static_cast<double>(all);
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
