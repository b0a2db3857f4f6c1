// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace dynamic_icp::simd {

// Two ways to write a kernel for vectors, both within simd::run and with the same bits at every level:
//   - where the compiler turns loops into vectors by itself, as over columns of numbers, plain arrays as lanes: below,
//     and ego_motion/velocity_modes.cpp in single precision. The first choice.
//   - where it does not, because a loop searches, compares or jumps, vectors of four written out: base/lanes.hpp.

/// A sum over rows in lanes: row i is added to lane i modulo their number, whatever the machine, for loops that the
/// compiler turns into vectors (DYNAMIC_ICP_LANE_LOOP).
inline constexpr std::size_t kSumLanes = 8;
using LaneSum = std::array<double, kSumLanes>;

inline double total(const LaneSum& lanes) {
  double sum = 0.0;
  for (const double lane : lanes) {
    sum += lane;
  }
  return sum;
}

inline Eigen::Vector3d total(const std::array<LaneSum, 3>& a) { return {total(a[0]), total(a[1]), total(a[2])}; }

/// From xx, xy, xz, yy, yz, zz.
inline Eigen::Matrix3d symmetric_total(const std::array<LaneSum, 6>& a) {
  Eigen::Matrix3d matrix;
  matrix << total(a[0]), total(a[1]), total(a[2]), 0.0, total(a[3]), total(a[4]), 0.0, 0.0, total(a[5]);
  return matrix.selfadjointView<Eigen::Upper>();
}

}  // namespace dynamic_icp::simd
