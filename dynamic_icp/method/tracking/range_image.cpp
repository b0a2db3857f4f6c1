// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/range_image.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <iterator>
#include <vector>

#include "dynamic_icp/method/tracking/image_cells.hpp"
#include "dynamic_icp/method/tracking/memory.hpp"

namespace dynamic_icp::tracking {
namespace {

constexpr std::size_t kPlacesAlong = 25;  // of a way that are looked at ...
constexpr double kOnWay_m = 0.3;          // ... and how far from them things are on it
constexpr double kBehind_m = 1.0;         // what is so much nearer is another thing
constexpr float kSameSurface_m = 0.5F;    // between points of one surface that are next to each other
constexpr double kSurelyLess = 0.999;     // for rounding
constexpr double kMinBehindShare = 0.5;   // of the rows of a mirror image lie behind the mirror
constexpr double kFewBeside = 0.2;        // mirrors show less than this share of what is seen of themselves

}  // namespace

double RangeImage::cell_width() { return 8.0 / kImageColumns; }  // where the measure grows most slowly, at 45 degrees

RangeImage::RangeImage(const Scan& scan, const Eigen::Vector3d& velocity_sensor, const Workers& workers) {
  ScanPatches patches;
  if (scan.has_times()) {
    patches.bound_sights(scan, workers);
  } else {
    patches.bound(scan, workers);
  }
  show(scan, patches, velocity_sensor);
  image_->draw_all();
}

void RangeImage::show(const Scan& scan, const ScanPatches& patches, const Eigen::Vector3d& velocity_sensor) {
  if (!image_) {
    image_ = std::make_unique<LazyImage>();
  }
  image_->begin(scan, patches, velocity_sensor);
}

/// Whether something nearer is seen in the direction of a row of the scan, and beside it to all sides.
bool RangeImage::is_behind(std::uint32_t row) const {
  const auto column = static_cast<int>(image_->place(row) / kImageRows);
  const int image_row = static_cast<int>(image_->place(row) % kImageRows);
  const auto squared = static_cast<double>(image_->squared(row));
  const auto is_nearer = [&](int at_column, int at_row) {
    const auto nearest = static_cast<double>(
        image_->nearest_squared((at_column + kImageColumns) % kImageColumns, std::clamp(at_row, 0, kImageRows - 1)));
    // Ranges a and b differ by (a^2 - b^2) / (a + b): most roots need not be drawn.
    const double difference = squared - nearest;
    if (difference <= 0.0 || difference * difference < kSurelyLess * kBehind_m * kBehind_m * 4.0 * nearest) {
      return false;
    }
    return std::sqrt(nearest) < std::sqrt(squared) - kBehind_m;
  };
  return is_nearer(column, image_row) && is_nearer(column - 1, image_row) && is_nearer(column + 1, image_row) &&
         is_nearer(column, image_row - 1) && is_nearer(column, image_row + 1);
}

/// Whether two rows of the scan are on one surface: in the same cell or in two that touch, and about as far away.
bool RangeImage::are_beside(std::uint32_t a, std::uint32_t b) const {
  const std::uint32_t columns = image_->place(a) / kImageRows - image_->place(b) / kImageRows;
  const std::uint32_t image_rows = image_->place(a) % kImageRows - image_->place(b) % kImageRows;
  return columns + 1 <= 2 && image_rows + 1 <= 2 &&
         std::abs(std::sqrt(image_->squared(a)) - std::sqrt(image_->squared(b))) < kSameSurface_m;
}

/// Beside all that is seen in the directions of these rows, of which all points are drawn.
bool RangeImage::are_few(std::span<const std::uint32_t> rows) const {
  std::bitset<std::size_t{kImageColumns} * kImageRows> is_touched;
  ImagePart part = ImagePart::none();
  for (const std::uint32_t row : rows) {
    is_touched[image_->place(row)] = true;
    part.include(static_cast<int>(image_->place(row) / kImageRows), static_cast<int>(image_->place(row) % kImageRows));
  }
  std::size_t all = 0;
  image_->visit_drawn(part, [&](std::uint32_t row) { all += is_touched[image_->place(row)] ? 1 : 0; });
  return static_cast<double>(rows.size()) < kFewBeside * static_cast<double>(all);
}

void RangeImage::remove_mirrored(std::vector<std::uint32_t>& rows, std::vector<std::uint32_t>& memory) const {
  image_->draw_rows(rows);
  std::vector<std::uint32_t>& behind = memory;
  behind.clear();
  make_room(behind, rows.size());
  std::ranges::copy_if(rows, std::back_inserter(behind), [&](std::uint32_t row) { return is_behind(row); });
  if (static_cast<double>(behind.size()) >= kMinBehindShare * static_cast<double>(rows.size())) {
    if (are_few(rows)) {
      rows.clear();
    }
    return;
  }
  std::erase_if(behind, [&](std::uint32_t row) {
    return std::ranges::any_of(rows, [&](std::uint32_t other) { return are_beside(row, other) && !is_behind(other); });
  });
  std::erase_if(rows, [&](std::uint32_t row) { return std::ranges::binary_search(behind, row); });
}

bool RangeImage::sees_along(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double higher_m) const {
  if (!image_) {
    return false;
  }
  struct Place {
    int column, lowest_row, highest_row;
    double range_m;
  };
  std::array<Place, kPlacesAlong> places;
  ImagePart part = ImagePart::none();
  for (std::size_t i = 0; i < kPlacesAlong; ++i) {
    const Eigen::Vector3d at = from + static_cast<double>(i) / (kPlacesAlong - 1) * (to - from);
    const ImageCell low = image_cell(at);
    const ImageCell high = image_cell(at + higher_m * Eigen::Vector3d::UnitZ());
    places[i] = {low.column, low.row, high.row, at.norm()};
    part.include(low.column, low.row);
    part.include(high.column, high.row);
  }
  image_->draw_part(part);
  bool is_seen = false;
  image_->visit_drawn(part, [&](std::uint32_t row) {
    const auto column = static_cast<int>(image_->place(row) / kImageRows);
    const auto image_row = static_cast<int>(image_->place(row) % kImageRows);
    const double range_m = std::sqrt(static_cast<double>(image_->squared(row)));
    is_seen = is_seen || std::ranges::any_of(places, [&](const Place& place) {
                return column == place.column && image_row >= place.lowest_row && image_row <= place.highest_row &&
                       std::abs(range_m - place.range_m) < kOnWay_m;
              });
  });
  return is_seen;
}

bool RangeImage::is_above_all(const Eigen::Vector3d& point) const {
  const int row = image_cell(point).row;
  return image_ ? image_->is_above_all(row) : row > 0;
}

/// Whether something is seen in a column, or on both sides of it: lines of sight may be farther apart than columns.
bool RangeImage::is_in_view(int column) const {
  const auto sees = [&](int step) { return image_->sees((column + step + kImageColumns) % kImageColumns); };
  return sees(0) || ((sees(-1) || sees(-2)) && (sees(1) || sees(2)));
}

bool RangeImage::hides(const Eigen::Vector3d& point, double clearance_m) const {
  if (!image_) {
    return true;
  }
  const ImageCell cell = image_cell(point);
  // Of two cells above each other the one that holds more of what is seen above the point: below may be the ground.
  const ImageCell above = image_cell(point + 0.5 * kSlopePerRow * point.head<2>().norm() * Eigen::Vector3d::UnitZ());
  const bool is_hidden = std::sqrt(image_->nearest_squared(cell.column, above.row)) < point.norm() - clearance_m;
  return is_hidden || !is_in_view(cell.column) || image_->is_below_all(cell.row);
}

}  // namespace dynamic_icp::tracking
