// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/spatial/kd_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::spatial {
namespace {

constexpr std::uint32_t kNoIndex = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kParallelSubtrees = 16;
constexpr std::size_t kMaxDepth = 32;  // 2^32 points in leaves of 16 are 28 levels deep

void check_points(std::span<const Eigen::Vector3d> points) {
  if (points.size() >= kNoIndex) {
    throw DataError("kd-tree of " + std::to_string(points.size()) + " points, expected fewer than 4294967295");
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    // Written so that NaN fails.
    if (!(points[i].cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= KdTree::kLargestCoordinate_m)) {
      throw DataError("point " + std::to_string(i) + " has a coordinate that is not finite or beyond 1e150 m");
    }
  }
}

}  // namespace

KdTree::KdTree(std::span<const Eigen::Vector3d> points) : KdTree(points, Workers(1)) {}

KdTree::KdTree(std::span<const Eigen::Vector3d> points, const Workers& workers) : size_(points.size()) {
  check_points(points);
  if (points.empty()) {
    return;
  }
  std::vector<IndexedPoint> indexed(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    indexed[i] = {points[i], static_cast<std::uint32_t>(i)};
  }
  leaves_.assign((points.size() + kLeafSize - 1) / kLeafSize, Leaf::Constant(std::numeric_limits<double>::infinity()));
  splits_.resize(2 * leaves_.size() - 1);
  boxes_.resize(2 * leaves_.size() - 1);
  // The subtrees of one level do not touch each other's points and nodes.
  std::vector<Subtree> level{{root(), indexed}};
  while (workers.threads() > 1 && level.size() < kParallelSubtrees && !level.back().node.is_leaf()) {
    std::vector<Subtree> next(2 * level.size());
    workers.for_each(level.size(), 1, [&](std::size_t i) { std::tie(next[2 * i], next[2 * i + 1]) = split(level[i]); });
    level = std::move(next);
  }
  workers.for_each(level.size(), 1, [&](std::size_t i) { build(level[i]); });
  fill_leaves(indexed);
}

void KdTree::build(const Subtree& subtree) {
  if (subtree.node.is_leaf()) {
    boxes_[subtree.node.id] = box_around(subtree.points);
    splits_[subtree.node.id].smallest_index = smallest_index(subtree.points);
    std::sort(subtree.points.begin(), subtree.points.end(),
              [](const IndexedPoint& a, const IndexedPoint& b) { return a.index < b.index; });
    return;
  }
  const auto [left, right] = split(subtree);
  build(left);
  build(right);
}

/// Parts the points of an inner node across the longest side of their box.
std::pair<KdTree::Subtree, KdTree::Subtree> KdTree::split(const Subtree& subtree) {
  const auto& [node, points] = subtree;
  const Box& box = boxes_[node.id] = box_around(points);
  Eigen::Index axis = 0;
  (box.upper - box.lower).maxCoeff(&axis);
  const std::size_t left_size = (node.left().end_leaf - node.first_leaf) * kLeafSize;
  // Equal coordinates are parted by index: the tree is the same for every implementation of nth_element.
  std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(left_size), points.end(),
                   [axis](const IndexedPoint& a, const IndexedPoint& b) {
                     return a.point[axis] < b.point[axis] || (a.point[axis] == b.point[axis] && a.index < b.index);
                   });
  splits_[node.id] = {points[left_size].point[axis], static_cast<std::uint32_t>(axis), smallest_index(points)};
  return {{node.left(), points.first(left_size)}, {node.right(), points.subspan(left_size)}};
}

KdTree::Box KdTree::box_around(std::span<const IndexedPoint> points) {
  Box box{points.front().point.array(), points.front().point.array()};
  for (const IndexedPoint& p : points) {
    box.lower = box.lower.min(p.point.array());
    box.upper = box.upper.max(p.point.array());
  }
  return box;
}

std::uint32_t KdTree::smallest_index(std::span<const IndexedPoint> points) {
  std::uint32_t smallest = kNoIndex;
  for (const IndexedPoint& p : points) {
    smallest = std::min(smallest, p.index);
  }
  return smallest;
}

void KdTree::fill_leaves(std::span<const IndexedPoint> points) {
  order_.resize(points.size());
  positions_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    leaves_[i / kLeafSize].row(static_cast<Eigen::Index>(i % kLeafSize)) = points[i].point.transpose().array();
    order_[i] = points[i].index;
    positions_[points[i].index] = static_cast<std::uint32_t>(i);
  }
}

/// Calls visit(leaf) for the leaves that may hold a neighbour nearer than `limit`, the likeliest first. `limit` is read
/// again at every step, so that `visit` can tighten it. At equal distance the indices decide: without that, a search
/// among thousands of identical points would visit them all.
template <class VisitLeaf>
void KdTree::visit_leaves(const Eigen::Vector3d& query, const Neighbour& limit, const VisitLeaf& visit) const {
  // `offset` is the vector from the query to the cell of a node. Only the component along the split changes on the
  // way to the far child.
  struct Cell {
    Node node;
    Eigen::Array3d offset;
    double squared_distance;
  };
  std::array<Cell, kMaxDepth> waiting;  // at most one for each level
  std::size_t count = 0;
  const Box& all = boxes_.front();
  Cell cell{root(), (all.lower - query.array()).max(query.array() - all.upper).max(0.0), 0.0};
  cell.squared_distance = squared_length(cell.offset);
  while (true) {
    if (is_nearer({smallest_index(cell.node), cell.squared_distance}, limit)) {
      while (!cell.node.is_leaf()) {
        const Split& split = splits_[cell.node.id];
        const double beyond = query[split.axis] - split.value;
        Cell& far = waiting[count];
        far.node = beyond > 0.0 ? cell.node.left() : cell.node.right();
        far.offset = cell.offset;
        far.offset[split.axis] = std::abs(beyond);
        far.squared_distance = squared_length(far.offset);
        count += far.squared_distance <= limit.squared_distance ? 1 : 0;
        cell.node = beyond > 0.0 ? cell.node.right() : cell.node.left();
      }
      visit(cell.node.first_leaf);
    }
    if (count == 0) {
      return;
    }
    cell = waiting[--count];
  }
}

std::optional<Neighbour> KdTree::nearest(const Eigen::Vector3d& query, double max_distance_m) const {
  Neighbour best{kNoIndex, squared_gate(max_distance_m)};
  if (size_ == 0 || !query.allFinite()) {
    return std::nullopt;
  }
  visit_leaves(query, best, [&](std::size_t leaf) {
    const auto distances = squared_distances(leaves_[leaf], query);
    for (std::size_t row = 0; row < kLeafSize; ++row) {
      const double distance = distances[static_cast<Eigen::Index>(row)];
      if (distance <= best.squared_distance) {
        const Neighbour candidate{order_[leaf * kLeafSize + row], distance};
        best = is_nearer(candidate, best) ? candidate : best;
      }
    }
  });
  return best.index == kNoIndex ? std::nullopt : std::optional(best);
}

void KdTree::nearest_k(const Eigen::Vector3d& query, std::size_t k, double max_distance_m,
                       std::vector<Neighbour>& found) const {
  found.resize(std::min(k, size_));
  std::size_t count = 0;
  Neighbour limit{kNoIndex, squared_gate(max_distance_m)};
  if (!found.empty() && query.allFinite()) {
    visit_leaves(query, limit, [&](std::size_t leaf) {
      const auto distances = squared_distances(leaves_[leaf], query);
      const LeafRows near = rows_within(distances, limit.squared_distance);
      for (std::size_t j = 0; j < near.count; ++j) {
        const Neighbour candidate{order_[leaf * kLeafSize + near.rows[j]], distances[near.rows[j]]};
        if (is_nearer(candidate, limit)) {
          count += count < found.size() ? 1 : 0;  // else the farthest gives way
          insert_ordered(&found[0], &found[count - 1], candidate);
          limit = count == found.size() ? found[count - 1] : limit;
        }
      }
    });
  }
  found.resize(count);
}

}  // namespace dynamic_icp::spatial
