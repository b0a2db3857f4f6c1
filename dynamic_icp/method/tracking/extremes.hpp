// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "dynamic_icp/method/base/lanes.hpp"
#include "dynamic_icp/method/base/simd.hpp"

namespace dynamic_icp::tracking {

/// The least and the greatest of values that come to a kernel four by four, or one by one.
struct Extremes {
  simd::Lanes low;
  simd::Lanes high;

  DYNAMIC_ICP_INLINE explicit Extremes(double value) : low(value - simd::Lanes{}), high(low) {}
  DYNAMIC_ICP_INLINE void add(const simd::Lanes& values) {
    simd::keep_smaller(low, values);
    simd::keep_larger(high, values);
  }
  DYNAMIC_ICP_INLINE void add(double value) { add(value - simd::Lanes{}); }
  DYNAMIC_ICP_INLINE void take(double& least, double& greatest) const {
    least = std::min({low[0], low[1], low[2], low[3]});
    greatest = std::max({high[0], high[1], high[2], high[3]});
  }
};

}  // namespace dynamic_icp::tracking
