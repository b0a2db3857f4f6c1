// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>

namespace dynamic_icp::spatial {

// Cubic cells of space under one number each: a point p lies in the cell floor(p / edge), whose three coordinates stand
// side by side in one word, x in the highest bits.

inline constexpr int kCellBits = 21;
inline constexpr std::int64_t kCellsEachWay = std::int64_t{1} << (kCellBits - 1);

/// No cell has this key.
inline constexpr std::uint64_t kNoCell = ~std::uint64_t{0};

/// The key of a cell; each coordinate in [-kCellsEachWay, kCellsEachWay).
inline std::uint64_t cell_key(std::int64_t x, std::int64_t y, std::int64_t z) {
  const auto part = [](std::int64_t cell) { return static_cast<std::uint64_t>(cell + kCellsEachWay); };
  return part(x) << (2 * kCellBits) | part(y) << kCellBits | part(z);
}

/// floor(value) of a value that a 64-bit integer can hold, without the function call that portable code needs.
inline std::int64_t floor_to_int(double value) {
  const auto truncated = static_cast<std::int64_t>(value);
  return truncated - (static_cast<double>(truncated) > value ? 1 : 0);
}

/// The cell of a position in units of the edge, point / edge; kNoCell when that is out of reach or not finite.
inline std::uint64_t cell_key(const Eigen::Vector3d& in_cells) {
  constexpr auto kReach = static_cast<double>(kCellsEachWay);
  const bool in_reach =
      std::abs(in_cells.x()) < kReach && std::abs(in_cells.y()) < kReach && std::abs(in_cells.z()) < kReach;
  return in_reach ? cell_key(floor_to_int(in_cells.x()), floor_to_int(in_cells.y()), floor_to_int(in_cells.z()))
                  : kNoCell;
}

/// The same, but what is out of reach shares the outermost cells. For finite positions.
inline std::uint64_t clamped_cell_key(const Eigen::Vector3d& in_cells) {
  constexpr auto kReach = static_cast<double>(kCellsEachWay);
  const Eigen::Vector3d clamped = in_cells.cwiseMax(-kReach).cwiseMin(kReach - 1.0);
  return cell_key(floor_to_int(clamped.x()), floor_to_int(clamped.y()), floor_to_int(clamped.z()));
}

/// The coordinates of a cell.
inline Eigen::Matrix<std::int64_t, 3, 1> cell_coordinates(std::uint64_t key) {
  constexpr std::uint64_t kMask = (std::uint64_t{1} << kCellBits) - 1;
  const auto part = [&](int shift) { return static_cast<std::int64_t>(key >> shift & kMask) - kCellsEachWay; };
  return {part(2 * kCellBits), part(kCellBits), part(0)};
}

/// The middle of a cell, m.
inline Eigen::Vector3d cell_centre(std::uint64_t key, double edge_m) {
  return edge_m * (cell_coordinates(key).cast<double>() + Eigen::Vector3d::Constant(0.5));
}

}  // namespace dynamic_icp::spatial
