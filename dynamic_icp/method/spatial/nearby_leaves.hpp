// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "dynamic_icp/method/base/lanes.hpp"
#include "dynamic_icp/method/spatial/kd_tree.hpp"

namespace dynamic_icp::spatial {

/// Squared distances (m^2) from a point to those of a leaf, the same bits as `squared_distance`; infinite in rows
/// without a point.
DYNAMIC_ICP_INLINE void distances_to_leaf(const KdTree::Leaf& leaf, double x, double y, double z, double* squared) {
  const double* const columns = leaf.data();
  for (std::size_t i = 0; i < KdTree::kLeafSize; i += simd::kLanes) {
    simd::Lanes dx;
    simd::Lanes dy;
    simd::Lanes dz;
    simd::load(dx, columns + i);
    simd::load(dy, columns + KdTree::kLeafSize + i);
    simd::load(dz, columns + 2 * KdTree::kLeafSize + i);
    dx -= x;
    dy -= y;
    dz -= z;
    dx = (dx * dx + dy * dy) + dz * dz;
    simd::store(squared + i, dx);
  }
}

/// The leaves near some points that search together: one walk through the tree for all of them.
class NearbyLeaves {
 public:
  static constexpr std::size_t kCapacity = 256;
  using Leaves = std::array<std::uint32_t, kCapacity>;

  /// Lists the leaves whose boxes are at most the squared distance `limit` (m^2) away from `box`, in an order that does
  /// not depend on the limit. False when there are more than `kCapacity`: then the list is of no use.
  bool list(const KdTree& tree, const KdTree::Box& box, double limit);

  /// Those whose boxes are at most the squared distance `limit` away from a point, the first ones of `near`. Returns
  /// their number.
  DYNAMIC_ICP_INLINE std::size_t near(double x, double y, double z, double limit, Leaves& near) const {
    std::array<double, kCapacity> reach;
    for (std::size_t j = 0; j < count_; j += simd::kLanes) {
      simd::Lanes dx;
      simd::Lanes dy;
      simd::Lanes dz;
      distances_beyond(&lower_[0][j], &upper_[0][j], x, dx);
      distances_beyond(&lower_[1][j], &upper_[1][j], y, dy);
      distances_beyond(&lower_[2][j], &upper_[2][j], z, dz);
      dx = (dx * dx + dy * dy) + dz * dz;
      simd::store(&reach[j], dx);
    }
    std::size_t count = 0;
    for (std::size_t j = 0; j < count_; ++j) {
      near[count] = leaves_[j];
      count += reach[j] <= limit ? 1 : 0;
    }
    return count;
  }

 private:
  using Bounds = std::array<double, kCapacity>;

  /// How far a coordinate lies outside of four intervals.
  static DYNAMIC_ICP_INLINE void distances_beyond(const double* lower, const double* upper, double x,
                                                  simd::Lanes& beyond) {
    simd::Lanes above;
    simd::load(beyond, lower);
    simd::load(above, upper);
    beyond -= x;
    above = x - above;
    simd::keep_larger(beyond, above);
    simd::keep_where(beyond, beyond > 0.0);
  }

  std::size_t count_ = 0;
  Leaves leaves_;
  std::array<Bounds, 3> lower_;
  std::array<Bounds, 3> upper_;
};

}  // namespace dynamic_icp::spatial
