// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/coordinates.hpp"

#include <algorithm>

#include "dynamic_icp/method/base/lanes.hpp"
#include "dynamic_icp/method/base/simd.hpp"

namespace dynamic_icp::tracking {
namespace {

/// The least and the greatest of `count` rows of a table, at least one, column by column.
template <std::size_t kColumns>
DYNAMIC_ICP_INLINE void find_extremes(const double* table, std::size_t count, std::array<double, kColumns>& low,
                                      std::array<double, kColumns>& high) {
  std::copy(table, table + kColumns, low.begin());
  high = low;
  std::size_t row = 0;
  if (count >= simd::kLanes) {
    // As many vectors as columns are four rows.
    std::array<simd::Lanes, kColumns> least;
    std::array<simd::Lanes, kColumns> greatest;
    for (std::size_t k = 0; k < kColumns; ++k) {
      simd::load(least[k], table + k * simd::kLanes);
      greatest[k] = least[k];
    }
    for (row = simd::kLanes; row + simd::kLanes <= count; row += simd::kLanes) {
      for (std::size_t k = 0; k < kColumns; ++k) {
        simd::Lanes values;
        simd::load(values, table + row * kColumns + k * simd::kLanes);
        simd::keep_smaller(least[k], values);
        simd::keep_larger(greatest[k], values);
      }
    }
    for (std::size_t i = 0; i < kColumns * simd::kLanes; ++i) {
      low[i % kColumns] = std::min(low[i % kColumns], least[i / simd::kLanes][i % simd::kLanes]);
      high[i % kColumns] = std::max(high[i % kColumns], greatest[i / simd::kLanes][i % simd::kLanes]);
    }
  }
  for (std::size_t i = row * kColumns; i < count * kColumns; ++i) {
    low[i % kColumns] = std::min(low[i % kColumns], table[i]);
    high[i % kColumns] = std::max(high[i % kColumns], table[i]);
  }
}

}  // namespace

void Coordinates::take(const Eigen::Vector3d* points, std::size_t count) {
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const double* p = points->data();
    for (std::size_t i = 0; i < count; ++i) {
      x[i] = p[3 * i];
      y[i] = p[3 * i + 1];
      z[i] = p[3 * i + 2];
    }
  });
}

Eigen::AlignedBox3d box_around(const Eigen::Vector3d* points, std::size_t count) {
  std::array<double, 3> low{};
  std::array<double, 3> high{};
  simd::run([&]() DYNAMIC_ICP_KERNEL { find_extremes(points->data(), count, low, high); });
  return {Eigen::Vector3d(low[0], low[1], low[2]), Eigen::Vector3d(high[0], high[1], high[2])};
}

Interval interval_around(std::span<const double> values) {
  std::array<double, 1> low{};
  std::array<double, 1> high{};
  simd::run([&]() DYNAMIC_ICP_KERNEL { find_extremes(values.data(), values.size(), low, high); });
  return {low[0], high[0]};
}

}  // namespace dynamic_icp::tracking
