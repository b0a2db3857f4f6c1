// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/coordinates.hpp"

#include "dynamic_icp/method/base/lanes.hpp"
#include "dynamic_icp/method/base/simd.hpp"
#include "dynamic_icp/method/tracking/extremes.hpp"

namespace dynamic_icp::tracking {
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

Interval interval_around(std::span<const double> values) {
  Interval result;
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const double* const value = values.data();
    const std::size_t n = values.size();
    Extremes extremes(value[0]);
    std::size_t i = 0;
    for (; i + simd::kLanes <= n; i += simd::kLanes) {
      simd::Lanes four;
      simd::load(four, value + i);
      extremes.add(four);
    }
    for (; i < n; ++i) {
      extremes.add(value[i]);
    }
    extremes.take(result.low, result.high);
  });
  return result;
}

}  // namespace dynamic_icp::tracking
