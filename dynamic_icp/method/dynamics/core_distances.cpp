// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/dynamics/core_distances.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "dynamic_icp/method/base/lanes.hpp"
#include "dynamic_icp/method/spatial/neighbourhoods.hpp"

namespace dynamic_icp::dynamics {
namespace {

using spatial::KdTree;
using spatial::Neighbour;

constexpr std::size_t kLeavesPerBlock = 32;
constexpr std::size_t kMaxNeighbours = 16;
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// What was found around one point: positions and squared distances, the point itself among them.
struct Found {
  std::span<const std::uint32_t> positions;
  std::span<const double> squared;
};

/// Up to so many found points are ordered by their ranks.
constexpr std::size_t kMaxRanked = 20;
static_assert(kMaxRanked % simd::kLanes == 0 && kMaxRanked > kMaxNeighbours);
using Places = std::array<std::uint32_t, kMaxRanked>;

/// Orders found points by distance: places[rank] is where the one of that rank stands. Counting for each how many are
/// nearer takes more comparisons than sorting, but no branch that is hard to predict. False where distances are equal:
/// then ranks do not tell the order.
DYNAMIC_ICP_INLINE bool order_by_rank(std::span<const double> squared, Places& places) {
  const std::size_t n = squared.size();
  std::array<double, kMaxRanked> values;
  values.fill(kUnbounded);
  std::copy_n(squared.data(), n, values.begin());
  std::size_t sum_of_ranks = 0;
  for (std::size_t begin = 0; begin < n; begin += simd::kLanes) {
    simd::Lanes lanes;
    simd::load(lanes, &values[begin]);
    simd::LaneMask ranks = {};
    for (std::size_t i = 0; i < n; ++i) {
      ranks -= values[i] < lanes;
    }
    for (std::size_t i = begin; i < std::min(begin + simd::kLanes, n); ++i) {
      const auto rank = static_cast<std::size_t>(ranks[i - begin]);
      places[rank] = static_cast<std::uint32_t>(i);
      sum_of_ranks += rank;
    }
  }
  return sum_of_ranks == n * (n - 1) / 2;
}

/// The general case: the others around the point at position `self`, the first `ordered` ones in order, the rest after
/// them. Their `index` is a position.
std::vector<Neighbour> ordered_others(const KdTree& tree, const Found& found, std::uint32_t self, std::size_t ordered) {
  std::vector<Neighbour> others;
  for (std::size_t i = 0; i < found.positions.size(); ++i) {
    others.push_back({found.positions[i], found.squared[i]});
  }
  const auto is_nearer = [&](const Neighbour& a, const Neighbour& b) {
    return spatial::is_nearer({tree.order()[a.index], a.squared_distance}, {tree.order()[b.index], b.squared_distance});
  };
  // Among many identical points the point itself need not be found: then one of its twins takes its place.
  const auto own = std::find_if(others.begin(), others.end(), [&](const Neighbour& f) { return f.index == self; });
  if (own == others.end()) {
    std::iter_swap(std::max_element(others.begin(), others.end(), is_nearer), others.end() - 1);
  } else {
    std::iter_swap(own, others.end() - 1);
  }
  others.pop_back();
  std::partial_sort(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(ordered), others.end(), is_nearer);
  return others;
}

void keep_others(CoreDistances& cores, std::uint32_t self, const std::vector<Neighbour>& others) {
  for (const Neighbour& other : others) {
    cores.squared[self] = std::max(cores.squared[self], other.squared_distance);
  }
  for (std::size_t k = 0; k < cores.neighbours_each; ++k) {
    cores.neighbours[self * cores.neighbours_each + k] = others[k].index;
  }
}

/// The same where no two found points are equally far away: the first is the point itself.
DYNAMIC_ICP_INLINE void keep_others(CoreDistances& cores, std::uint32_t self, const Found& found,
                                    const Places& places) {
  cores.squared[self] = found.squared[places[found.squared.size() - 1]];
  for (std::size_t k = 0; k < cores.neighbours_each; ++k) {
    cores.neighbours[self * cores.neighbours_each + k] = found.positions[places[k + 1]];
  }
}

/// Without a branch, as above.
void keep_dense_neighbours(CoreDistances& cores, std::size_t position) {
  const double* const squared = cores.squared.data();
  const double own = squared[position];
  const std::size_t each = cores.neighbours_each;
  std::uint32_t* const neighbours = cores.neighbours.data() + position * each;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < each; ++i) {
    const std::uint32_t other = neighbours[i];
    neighbours[kept] = other;
    kept += squared[other] <= own ? 1 : 0;
  }
  for (std::size_t i = 0; i < each; ++i) {
    neighbours[i] = i < kept ? neighbours[i] : CoreDistances::kNone;
  }
}

}  // namespace

CoreDistances core_distances(const KdTree& tree, std::span<const Eigen::Vector3d> points, std::size_t min_samples,
                             const Workers& workers) {
  CoreDistances cores;
  cores.squared.assign(tree.leaf_count() * KdTree::kLeafSize, kUnbounded);
  std::fill_n(cores.squared.begin(), tree.size(), 0.0);
  cores.neighbours_each = std::min(min_samples, kMaxNeighbours);
  cores.neighbours.resize(points.size() * cores.neighbours_each);
  workers.for_blocks(tree.leaf_count(), kLeavesPerBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
    spatial::Neighbourhoods found(tree, min_samples + 1, kUnbounded);
    for (std::size_t leaf = begin; leaf < end; ++leaf) {
      found.search(leaf);
      simd::run([&]() DYNAMIC_ICP_KERNEL {
        for (std::size_t row = 0; row < found.rows(); ++row) {
          const auto self = static_cast<std::uint32_t>(leaf * KdTree::kLeafSize + row);
          const Found around{found.positions(row), found.squared_distances(row)};
          Places places;
          if (min_samples < kMaxRanked && order_by_rank(around.squared, places)) {
            keep_others(cores, self, around, places);
          } else {
            keep_others(cores, self, ordered_others(tree, around, self, cores.neighbours_each));
          }
        }
      });
    }
  });
  workers.for_each(points.size(), 256, [&](std::size_t i) { keep_dense_neighbours(cores, i); });
  return cores;
}

}  // namespace dynamic_icp::dynamics
