// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>

#include <Eigen/Core>

#include "dynamic_icp/method/base/simd.hpp"

namespace dynamic_icp::tracking {

// The cells of an image of all directions, for kernels too.

inline constexpr int kImageColumns = 720;  // in one turn
inline constexpr int kImageRows = 120;
inline constexpr double kSlopePerRow = 0.0175;  // a degree
inline constexpr double kMinDivisor_m = 1e-12;  // nothing is divided by less

struct ImageCell {
  int column = 0;
  int row = 0;
};

/// A measure of the azimuth that grows with it from 0 to 4 in one turn, without an arc tangent.
DYNAMIC_ICP_INLINE double turn_measure(double x, double y) {
  const double sum = std::abs(x) + std::abs(y);
  const double a = y / (sum > kMinDivisor_m ? sum : kMinDivisor_m);
  const double right = y < 0.0 ? 4.0 + a : a;
  return x < 0.0 ? 2.0 - a : right;
}

/// The row of what is `z` (m) above the sensor at this distance from its vertical axis, not rounded and beyond the
/// image, too.
DYNAMIC_ICP_INLINE double image_row(double z, double across) {
  return z / (across > kMinDivisor_m ? across : kMinDivisor_m) * (1.0 / kSlopePerRow) + 0.5 * kImageRows;
}

/// The nearest row that there is, rounded down.
DYNAMIC_ICP_INLINE int row_in_image(double row) {
  const double not_above = row < kImageRows - 1.0 ? row : kImageRows - 1.0;
  return static_cast<int>(not_above > 0.0 ? not_above : 0.0);
}

DYNAMIC_ICP_INLINE ImageCell image_cell(double x, double y, double z) {
  const int column = static_cast<int>(turn_measure(x, y) * (0.25 * kImageColumns));
  return {column < kImageColumns ? column : kImageColumns - 1, row_in_image(image_row(z, std::sqrt(x * x + y * y)))};
}

inline ImageCell image_cell(const Eigen::Vector3d& point) { return image_cell(point.x(), point.y(), point.z()); }

/// The place of a cell in an image that lies column by column.
inline std::size_t place_in_image(int column, int row) { return static_cast<std::size_t>(column * kImageRows + row); }

}  // namespace dynamic_icp::tracking
