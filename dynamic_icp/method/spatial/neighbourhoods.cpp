// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/spatial/neighbourhoods.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "dynamic_icp/method/base/lanes.hpp"

namespace dynamic_icp::spatial {
namespace {

using simd::kLanes;
using simd::LaneMask;
using simd::Lanes;
using simd::load;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRoundingUp = 1.0 + 1e-12;  // more than all rounding in a bound
constexpr int kMaxGuesses = 12;

/// How many of the values, whose number is a multiple of four, do not exceed the limit.
DYNAMIC_ICP_INLINE std::size_t count_within(const double* values, std::size_t n, double limit) {
  LaneMask count = {};
  for (std::size_t i = 0; i < n; i += kLanes) {
    Lanes value;
    load(value, values + i);
    count -= value <= limit;
  }
  return static_cast<std::size_t>((count[0] + count[1]) + (count[2] + count[3]));
}

/// A number that exactly `k` < n of the values do not exceed, or a negative one if none is found soon, as when values
/// are equal. `largest` is no less than any value. Squared distances to points on a surface are spread evenly: a guess
/// in proportion is good.
DYNAMIC_ICP_INLINE double parting_value(const double* values, std::size_t n, std::size_t k, double largest) {
  double low = 0.0;
  double high = largest;
  double low_count = 0.0;
  auto high_count = static_cast<double>(n);
  const auto wanted = static_cast<double>(k);
  for (int guess = 0; guess < kMaxGuesses; ++guess) {
    // Half a point more: any value between two neighbours will do.
    const double share = guess % 4 == 3 ? 0.5 : (wanted + 0.5 - low_count) / (high_count + 0.5 - low_count);
    const double middle = low + (high - low) * share;
    const std::size_t count = count_within(values, n, middle);
    if (count == k) {
      return middle;
    }
    if (count > k) {
      high = middle;
      high_count = static_cast<double>(count);
    } else {
      low = middle;
      low_count = static_cast<double>(count);
    }
  }
  return -1.0;
}

/// The pairs that Batcher's odd-even merge sort of a leaf's rows puts in order, one after the other.
constexpr auto kSortingPairs = [] {
  constexpr std::size_t kRows = KdTree::kLeafSize;
  std::array<std::array<std::uint8_t, 2>, 63> pairs{};
  std::size_t count = 0;
  for (std::size_t sorted = 1; sorted < kRows; sorted *= 2) {
    for (std::size_t apart = sorted; apart > 0; apart /= 2) {
      for (std::size_t i = apart % sorted; i + apart < kRows; ++i) {
        const bool lower = (i - apart % sorted) / apart % 2 == 0;
        if (lower && i / (2 * sorted) == (i + apart) / (2 * sorted)) {
          pairs.at(count++) = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i + apart)};
        }
      }
    }
  }
  return pairs;
}();

/// Squared distances from four rows of a leaf, the lanes, to all of its rows.
using RowDistances = std::array<Lanes, KdTree::kLeafSize>;

DYNAMIC_ICP_INLINE void distances_within_leaf(const KdTree::Leaf& leaf, std::size_t first, RowDistances& squared) {
  const double* const columns = leaf.data();
  Lanes x;
  Lanes y;
  Lanes z;
  load(x, columns + first);
  load(y, columns + KdTree::kLeafSize + first);
  load(z, columns + 2 * KdTree::kLeafSize + first);
  for (std::size_t row = 0; row < KdTree::kLeafSize; ++row) {
    const Lanes dx = x - columns[row];
    const Lanes dy = y - columns[KdTree::kLeafSize + row];
    const Lanes dz = z - columns[2 * KdTree::kLeafSize + row];
    squared[row] = (dx * dx + dy * dy) + dz * dz;
  }
}

/// Sorts in each lane. Always the same steps: no branch to predict.
DYNAMIC_ICP_INLINE void sort_lanes(RowDistances& values) {
  for (const auto& [i, j] : kSortingPairs) {
    const Lanes a = values[i];
    const Lanes b = values[j];
    const LaneMask changes = ((LaneMask)a ^ (LaneMask)b) & (a > b);
    values[i] = (Lanes)((LaneMask)a ^ changes);
    values[j] = (Lanes)((LaneMask)b ^ changes);
  }
}

}  // namespace

Neighbourhoods::Neighbourhoods(const KdTree& tree, std::size_t k, double max_distance_m)
    : tree_(tree),
      k_(std::min(k, tree.size())),
      max_distance_m_(max_distance_m),
      squared_gate_(squared_gate(max_distance_m)),
      stride_(k_ + kLeafSize),
      found_squared_(kLeafSize * stride_),
      found_positions_(kLeafSize * stride_),
      squared_((NearbyLeaves::kCapacity + 1) * kLeafSize),
      positions_((NearbyLeaves::kCapacity + 1) * kLeafSize) {
  forget_rows();
}

void Neighbourhoods::search(std::size_t leaf) {
  const bool first = rows_ == 0;
  rows_ = std::min(kLeafSize, tree_.size() - leaf * kLeafSize);
  bounds_.fill(squared_gate_);
  if (k_ == 0 || !(squared_gate_ >= 0.0)) {
    counts_.fill(0);
    return;
  }
  if (first) {
    tree_.nearest_k(point(leaf, 0), k_, max_distance_m_, alone_);
    if (alone_.size() == k_) {
      know_row(0, alone_.back().squared_distance);
    }
    leaf_ = leaf;
  }
  simd::run([&]() DYNAMIC_ICP_KERNEL { bound_by_leaf_before(leaf); });
  if (k_ < rows_) {
    simd::run([&]() DYNAMIC_ICP_KERNEL { bound_by_own_leaf(leaf); });
  }
  leaf_ = leaf;
  if (!list_leaves(leaf)) {
    search_one_by_one(leaf);
    return;
  }
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    for (std::size_t row = 0; row < rows_; ++row) {
      search_listed(leaf, row);
    }
  });
}

void Neighbourhoods::forget_rows() {
  reached_.fill(0.0);
  not_reached_.fill(kInfinity);
}

void Neighbourhoods::know_row(std::size_t row, double squared_distance) {
  reached_[row] = std::sqrt(squared_distance) * kRoundingUp;
  not_reached_[row] = 0.0;
}

void Neighbourhoods::search_one_by_one(std::size_t leaf) {
  forget_rows();
  for (std::size_t row = 0; row < rows_; ++row) {
    search_alone(leaf, row);
  }
}

void Neighbourhoods::search_alone(std::size_t leaf, std::size_t row) {
  tree_.nearest_k(point(leaf, row), k_, max_distance_m_, alone_);
  counts_[row] = alone_.size();
  for (std::size_t i = 0; i < alone_.size(); ++i) {
    found_positions_[row * stride_ + i] = tree_.positions()[alone_[i].index];
    found_squared_[row * stride_ + i] = alone_[i].squared_distance;
  }
  if (alone_.size() == k_) {
    know_row(row, alone_.back().squared_distance);
  }
}

/// Triangle inequality: around a point there are `k` points as near as around another, and the way to that.
DYNAMIC_ICP_INLINE double Neighbourhoods::bound_by_known_rows(const Eigen::Vector3d& p) const {
  LeafValues squared;
  distances_to_leaf(tree_.leaf(leaf_), p.x(), p.y(), p.z(), squared.data());
  double least = kInfinity;
  double reached = kInfinity;
  for (std::size_t i = 0; i < kLeafSize; ++i) {
    const double distance = squared[i] + not_reached_[i];
    reached = distance < least ? reached_[i] : reached;
    least = distance < least ? distance : least;
  }
  const double reach = reached + std::sqrt(least);
  return reach * reach * kRoundingUp;
}

DYNAMIC_ICP_INLINE void Neighbourhoods::bound_by_leaf_before(std::size_t leaf) {
  for (std::size_t row = 0; row < rows_; ++row) {
    bounds_[row] = std::min(bounds_[row], bound_by_known_rows(point(leaf, row)));
  }
}

DYNAMIC_ICP_INLINE void Neighbourhoods::bound_by_own_leaf(std::size_t leaf) {
  for (std::size_t first = 0; first < rows_; first += kLanes) {
    RowDistances squared;
    distances_within_leaf(tree_.leaf(leaf), first, squared);
    sort_lanes(squared);
    for (std::size_t row = first; row < std::min(first + kLanes, rows_); ++row) {
      bounds_[row] = std::min(bounds_[row], squared[k_ - 1][row - first]);
    }
  }
}

/// Lists the leaves that may hold neighbours of any row; false when there are too many.
bool Neighbourhoods::list_leaves(std::size_t leaf) {
  KdTree::Box box{point(leaf, 0).array(), point(leaf, 0).array()};
  double limit = 0.0;
  for (std::size_t row = 0; row < rows_; ++row) {
    box.lower = box.lower.min(point(leaf, row).array());
    box.upper = box.upper.max(point(leaf, row).array());
    limit = std::max(limit, bounds_[row]);
  }
  return listed_.list(tree_, box, limit);
}

DYNAMIC_ICP_INLINE void Neighbourhoods::search_listed(std::size_t leaf, std::size_t row) {
  if (row == 0) {
    forget_rows();
  } else {
    // Rows of the same leaf are nearer than those of the leaf before.
    bounds_[row] = std::min(bounds_[row], bound_by_known_rows(point(leaf, row)));
  }
  collect(point(leaf, row), bounds_[row]);
  keep_nearest(row);
}

/// Collects all points within the squared distance `limit`.
DYNAMIC_ICP_INLINE void Neighbourhoods::collect(const Eigen::Vector3d& query, double limit) {
  const double x = query.x();
  const double y = query.y();
  const double z = query.z();
  NearbyLeaves::Leaves near;
  const std::size_t near_count = listed_.near(x, y, z, limit, near);
  double* const squared = squared_.data();
  std::uint32_t* const positions = positions_.data();
  std::size_t count = 0;
  for (std::size_t j = 0; j < near_count; ++j) {
    LeafValues distances;
    distances_to_leaf(tree_.leaf(near[j]), x, y, z, distances.data());
    const auto first = static_cast<std::uint32_t>(near[j] * kLeafSize);
    // Without a branch: which points are near is hard to predict.
    for (std::uint32_t i = 0; i < kLeafSize; ++i) {
      squared[count] = distances[i];
      positions[count] = first + i;
      count += distances[i] <= limit ? 1 : 0;
    }
  }
  candidates_ = count;
  for (std::size_t i = 0; i < kLanes; ++i) {
    squared[count + i] = kInfinity;  // to full lanes
  }
}

DYNAMIC_ICP_INLINE void Neighbourhoods::keep_nearest(std::size_t row) {
  double* const found = &found_squared_[row * stride_];
  std::uint32_t* const found_positions = &found_positions_[row * stride_];
  double limit = bounds_[row];
  if (candidates_ > k_) {
    limit = parting_value(squared_.data(), candidates_, k_, limit);
    if (limit < 0.0) {
      keep_nearest_by_index(row);
      return;
    }
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < candidates_; ++i) {
    found[count] = squared_[i];
    found_positions[count] = positions_[i];
    count += squared_[i] <= limit ? 1 : 0;
  }
  counts_[row] = count;
  if (count == k_) {
    know_row(row, limit);
  }
}

void Neighbourhoods::keep_nearest_by_index(std::size_t row) {
  alone_.resize(candidates_);
  for (std::size_t i = 0; i < candidates_; ++i) {
    alone_[i] = {tree_.order()[positions_[i]], squared_[i]};
  }
  std::nth_element(alone_.begin(), alone_.begin() + static_cast<std::ptrdiff_t>(k_ - 1), alone_.end(), is_nearer);
  const Neighbour last = alone_[k_ - 1];
  std::size_t count = 0;
  for (std::size_t i = 0; i < candidates_; ++i) {
    found_squared_[row * stride_ + count] = squared_[i];
    found_positions_[row * stride_ + count] = positions_[i];
    count += is_nearer(last, {tree_.order()[positions_[i]], squared_[i]}) ? 0 : 1;
  }
  counts_[row] = count;
  know_row(row, last.squared_distance);
}

}  // namespace dynamic_icp::spatial
