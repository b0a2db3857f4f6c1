// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/spatial/space_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace dynamic_icp::spatial {
namespace {

constexpr double kCells = 1024.0;  // along each axis

struct Keyed {
  std::uint32_t key;
  std::uint32_t row;
};

/// The ten bits of a cell's number, each followed by two zeros.
std::uint32_t spread(double cell) {
  auto bits = static_cast<std::uint32_t>(std::clamp(cell + 0.5 * kCells, 0.0, kCells - 1.0));
  bits = (bits | bits << 16) & 0x030000ff;
  bits = (bits | bits << 8) & 0x0300f00f;
  bits = (bits | bits << 4) & 0x030c30c3;
  return (bits | bits << 2) & 0x09249249;
}

/// One pass of a radix sort: stable, by ten bits from `shift` on.
void sort_by_bits(const std::vector<Keyed>& from, std::vector<Keyed>& to, unsigned shift) {
  constexpr std::uint32_t kMask = 1023;
  std::array<std::uint32_t, kMask + 1> next{};
  for (const Keyed& k : from) {
    ++next[k.key >> shift & kMask];
  }
  std::uint32_t sum = 0;
  for (std::uint32_t& n : next) {
    sum += n;
    n = sum - n;
  }
  for (const Keyed& k : from) {
    to[next[k.key >> shift & kMask]++] = k;
  }
}

}  // namespace

std::vector<std::uint32_t> space_order(std::span<const Eigen::Vector3d> points, double cell_m) {
  std::vector<Keyed> keyed(points.size());
  for (std::uint32_t row = 0; row < points.size(); ++row) {
    const Eigen::Vector3d cell = points[row] / cell_m;
    keyed[row] = {spread(cell.x()) | spread(cell.y()) << 1 | spread(cell.z()) << 2, row};
  }
  std::vector<Keyed> other(keyed.size());
  sort_by_bits(keyed, other, 0);
  sort_by_bits(other, keyed, 10);
  sort_by_bits(keyed, other, 20);
  std::vector<std::uint32_t> order(points.size());
  std::transform(other.begin(), other.end(), order.begin(), [](const Keyed& k) { return k.row; });
  return order;
}

}  // namespace dynamic_icp::spatial
