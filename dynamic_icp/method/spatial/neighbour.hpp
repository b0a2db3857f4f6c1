// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <Eigen/Core>

namespace dynamic_icp::spatial {

/// A point found by a search.
struct Neighbour {
  std::uint32_t index = 0;        ///< row of the point in the span the tree was built from
  double squared_distance = 0.0;  ///< m^2, formed as (dx^2 + dy^2) + dz^2
};

/// The order of results: by distance, and by index where distances are equal.
inline bool is_nearer(const Neighbour& a, const Neighbour& b) {
  return a.squared_distance < b.squared_distance || (a.squared_distance == b.squared_distance && a.index < b.index);
}

/// Puts `candidate` at its place among the ordered neighbours [first, last), moving the farther ones up by one; there
/// must be room for one more at `last`.
inline void insert_ordered(Neighbour* first, Neighbour* last, const Neighbour& candidate) {
  // Equal distances are rare: most steps compare nothing but distances.
  for (; last != first && candidate.squared_distance < last[-1].squared_distance; --last) {
    *last = last[-1];
  }
  for (; last != first && is_nearer(candidate, last[-1]); --last) {
    *last = last[-1];
  }
  *last = candidate;
}

/// The square of the distance of two points (m^2), its terms added in the same order everywhere: a distance that is
/// computed again has the same bits.
inline double squared_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d d = a - b;
  return (d.x() * d.x() + d.y() * d.y()) + d.z() * d.z();
}

/// The square of the distance at which a search ends: negative when nothing can be found, for negative distances and
/// NaN; never infinite, so that no result is.
inline double squared_gate(double max_distance_m) {
  return max_distance_m >= 0.0 ? std::min(max_distance_m * max_distance_m, std::numeric_limits<double>::max()) : -1.0;
}

}  // namespace dynamic_icp::spatial
