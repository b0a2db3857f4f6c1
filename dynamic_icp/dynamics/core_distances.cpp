// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/dynamics/core_distances.hpp"

#include <algorithm>
#include <cmath>

namespace dynamic_icp::dynamics {
namespace {

using spatial::KdTree;
using spatial::Neighbour;

constexpr std::size_t kMostNeighbours = 16;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<std::uint32_t> positions_of_points(const KdTree& tree) {
  std::vector<std::uint32_t> positions(tree.size());
  for (std::uint32_t position = 0; position < tree.size(); ++position) {
    positions[tree.order()[position]] = position;
  }
  return positions;
}

/// The `count` nearest points to the point `self` of the tree without itself. The search may end at `gate_m`, within
/// which that many are expected.
void nearest_others(const KdTree& tree, const Eigen::Vector3d& point, std::uint32_t self, std::size_t count,
                    double gate_m, std::vector<Neighbour>& found) {
  tree.nearest_k(point, count + 1, gate_m, found);
  if (found.size() <= count) {
    tree.nearest_k(point, count + 1, kInfinity, found);
  }
  // Among many identical points the point itself need not be found: then one of its twins takes its place.
  const auto own = std::find_if(found.begin(), found.end(), [&](const Neighbour& f) { return f.index == self; });
  found.erase(own == found.end() ? found.end() - 1 : own);
}

void keep_dense_neighbours(CoreDistances& cores, std::size_t position) {
  const auto begin = cores.neighbours.begin() + static_cast<std::ptrdiff_t>(position * cores.neighbours_each);
  const auto end = begin + static_cast<std::ptrdiff_t>(cores.neighbours_each);
  const auto is_sparser = [&](std::uint32_t other) { return cores.squared[other] > cores.squared[position]; };
  std::fill(std::remove_if(begin, end, is_sparser), end, CoreDistances::kNone);
}

}  // namespace

CoreDistances core_distances(const KdTree& tree, std::span<const Eigen::Vector3d> points, std::size_t min_samples,
                             const Workers& workers) {
  CoreDistances cores;
  cores.squared.assign(tree.leaf_count() * KdTree::kLeafSize, kInfinity);
  cores.neighbours_each = std::min(min_samples, kMostNeighbours);
  cores.neighbours.resize(points.size() * cores.neighbours_each);
  const std::vector<std::uint32_t> positions = positions_of_points(tree);
  workers.for_blocks(points.size(), 256, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::vector<Neighbour> found;
    double gate_m = kInfinity;
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t self = tree.order()[i];
      nearest_others(tree, points[self], self, min_samples, gate_m, found);
      cores.squared[i] = found.back().squared_distance;
      for (std::size_t k = 0; k < cores.neighbours_each; ++k) {
        cores.neighbours[i * cores.neighbours_each + k] = positions[found[k].index];
      }
      if (i + 1 < end) {
        // Triangle inequality: enough neighbours of the next point are among the neighbours of this one.
        const double step_m = (points[self] - points[tree.order()[i + 1]]).norm();
        gate_m = (std::sqrt(cores.squared[i]) + step_m) * (1.0 + 1e-12);
      }
    }
  });
  workers.for_each(points.size(), 256, [&](std::size_t i) { keep_dense_neighbours(cores, i); });
  return cores;
}

}  // namespace dynamic_icp::dynamics
