// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/point_thinning.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace dynamic_icp::figures {
namespace {

constexpr double kFinest_m = 0.02;  // edge of the cubes that no longer distinguishes points
constexpr int kBits = 21;           // for each coordinate
constexpr int kLevels = kBits + 1;  // cubes of kFinest_m 2^level; the last one holds everything

/// The lowest 21 bits, each followed by two zeros.
std::uint64_t spread_bits(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x001f00000000ffffULL;
  bits = (bits | bits << 16) & 0x001f0000ff0000ffULL;
  bits = (bits | bits << 8) & 0x100f00f00f00f00fULL;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3ULL;
  return (bits | bits << 2) & 0x1249249249249249ULL;
}

std::uint64_t morton_key(const Eigen::Vector3d& point) {
  constexpr double kHalf = static_cast<double>(1 << (kBits - 1));
  const auto part = [](double coordinate) {
    const double cell = std::clamp(std::floor(coordinate / kFinest_m) + kHalf, 0.0, 2.0 * kHalf - 1.0);
    return spread_bits(static_cast<std::uint64_t>(cell));
  };
  return part(point.x()) | part(point.y()) << 1 | part(point.z()) << 2;
}

struct Keyed {
  std::uint64_t key;
  std::uint32_t row;
};

/// At how many levels, from the finest on, a point lies in another cube than the one before it: at these it is the
/// first of its cube.
int level_between(std::uint64_t before, std::uint64_t key) {
  return before == key ? 0 : (static_cast<int>(std::bit_width(before ^ key)) + 2) / 3;
}

}  // namespace

std::vector<std::uint32_t> spread_rows(std::span<const Eigen::Vector3d> points, std::size_t count) {
  std::vector<Keyed> keyed(points.size());
  for (std::uint32_t row = 0; row < points.size(); ++row) {
    keyed[row] = {morton_key(points[row]), row};
  }
  std::sort(keyed.begin(), keyed.end(),
            [](const Keyed& a, const Keyed& b) { return a.key != b.key ? a.key < b.key : a.row < b.row; });
  std::vector<int> levels(keyed.size(), kLevels);
  std::array<std::size_t, kLevels + 1> of_level{};
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    levels[i] = i == 0 ? kLevels : level_between(keyed[i - 1].key, keyed[i].key);
    ++of_level[static_cast<std::size_t>(levels[i])];
  }
  // All points of the coarse levels, and of the level at the cut every so many-th.
  std::size_t whole = 0;
  int cut = kLevels;
  while (cut >= 0 && whole + of_level[static_cast<std::size_t>(cut)] <= count) {
    whole += of_level[static_cast<std::size_t>(cut)];
    --cut;
  }
  const std::size_t wanted = count - std::min(count, whole);
  const std::size_t there = cut >= 0 ? of_level[static_cast<std::size_t>(cut)] : 0;
  std::vector<std::uint32_t> rows;
  rows.reserve(std::min(count, points.size()));
  std::size_t seen = 0;
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    bool keep = levels[i] > cut;
    if (levels[i] == cut) {
      keep = (seen + 1) * wanted / there > seen * wanted / there;
      ++seen;
    }
    if (keep) {
      rows.push_back(keyed[i].row);
    }
  }
  return rows;
}

}  // namespace dynamic_icp::figures
