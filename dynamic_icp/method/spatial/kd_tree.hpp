// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/spatial/neighbour.hpp"

namespace dynamic_icp::spatial {

/// Exact nearest-neighbour search among 3D points.
///
/// The points are copied into leaves of `kLeafSize` points each, all full but the last, in the order of the leaves, so
/// that a search reads contiguous memory. A node that covers m leaves gives ceil(m / 2) of them to its left child: the
/// depth is ceil(log2(number of leaves)) whatever the points look like, and no child needs a stored link.
///
/// Guarantees: results depend on the points alone (equal distances are ordered by index); a tree is immutable and may
/// be searched by many threads at once; memory about 44 bytes a point. Building costs O(n log n).
class KdTree {
 public:
  static constexpr std::size_t kLeafSize = 16;
  static constexpr double kLargestCoordinate_m = 1e150;  ///< beyond, a squared distance might be infinite
  /// Coordinates of one leaf, a row per point. The rows after the last point of the tree are infinite.
  using Leaf = Eigen::Array<double, kLeafSize, 3>;

  /// The smallest axis-parallel box around the points of a node.
  struct Box {
    Eigen::Array3d lower = Eigen::Array3d::Zero();
    Eigen::Array3d upper = Eigen::Array3d::Zero();
  };

  /// A node of the tree for those who walk it themselves: it covers the leaves [first_leaf, end_leaf). Nodes are
  /// numbered in pre-order, so that a child's id is greater than its parent's.
  struct Node {
    std::uint32_t id = 0;
    std::uint32_t first_leaf = 0;
    std::uint32_t end_leaf = 0;

    [[nodiscard]] bool is_leaf() const { return end_leaf - first_leaf == 1; }
    [[nodiscard]] Node left() const { return {id + 1, first_leaf, middle()}; }
    [[nodiscard]] Node right() const { return {id + 2 * (middle() - first_leaf), middle(), end_leaf}; }

   private:
    [[nodiscard]] std::uint32_t middle() const { return first_leaf + (end_leaf - first_leaf + 1) / 2; }
  };

  /// Throws DataError naming the first point with a coordinate that is not finite or beyond `kLargestCoordinate_m`, and
  /// when there are 2^32 - 1 points or more.
  explicit KdTree(std::span<const Eigen::Vector3d> points);

  /// The same tree, bit for bit, built by several threads.
  KdTree(std::span<const Eigen::Vector3d> points, const Workers& workers);

  [[nodiscard]] std::size_t size() const { return size_; }

  /// The nearest point at distance <= `max_distance_m` (which may be infinite); of several the one with the smallest
  /// index. Empty when there is none, when the query is not finite and when `max_distance_m` is negative or NaN.
  [[nodiscard]] std::optional<Neighbour> nearest(const Eigen::Vector3d& query, double max_distance_m) const;

  /// The `k` nearest points at distance <= `max_distance_m`, ordered by distance and then by index, into `found`, whose
  /// former content is dropped; fewer where there are fewer. Does not allocate once `found` has the capacity. Meant for
  /// `k` up to some hundreds: every point found is inserted among the others.
  void nearest_k(const Eigen::Vector3d& query, std::size_t k, double max_distance_m,
                 std::vector<Neighbour>& found) const;

  // The structure, for algorithms that walk the tree. A position p in [0, size()) counts the points leaf by leaf: it
  // is row p % kLeafSize of leaf p / kLeafSize.

  [[nodiscard]] std::size_t leaf_count() const { return leaves_.size(); }
  [[nodiscard]] std::size_t node_count() const { return boxes_.size(); }
  /// The node over all points; only for trees that are not empty.
  [[nodiscard]] Node root() const { return {0, 0, static_cast<std::uint32_t>(leaves_.size())}; }
  [[nodiscard]] const Box& box(Node node) const { return boxes_[node.id]; }
  [[nodiscard]] const Leaf& leaf(std::size_t leaf) const { return leaves_[leaf]; }
  /// The smallest index among the points of a node.
  [[nodiscard]] std::uint32_t smallest_index(Node node) const { return splits_[node.id].smallest_index; }
  /// Index of the point at each position.
  [[nodiscard]] std::span<const std::uint32_t> order() const { return order_; }
  /// Position of each point: the other way round.
  [[nodiscard]] std::span<const std::uint32_t> positions() const { return positions_; }

 private:
  struct IndexedPoint {
    Eigen::Vector3d point;
    std::uint32_t index;
  };
  /// What a search needs of a node. An inner node parts its points: left <= value <= right along the axis.
  struct Split {
    double value = 0.0;
    std::uint32_t axis = 0;
    std::uint32_t smallest_index = 0;  ///< of all points of the node
  };

  /// A node and its points, not yet parted.
  struct Subtree {
    Node node;
    std::span<IndexedPoint> points;
  };

  static Box box_around(std::span<const IndexedPoint> points);
  static std::uint32_t smallest_index(std::span<const IndexedPoint> points);
  void build(const Subtree& subtree);
  [[nodiscard]] std::pair<Subtree, Subtree> split(const Subtree& subtree);
  void fill_leaves(std::span<const IndexedPoint> points);
  template <class VisitLeaf>
  void visit_leaves(const Eigen::Vector3d& query, const Neighbour& limit, const VisitLeaf& visit) const;

  std::size_t size_ = 0;
  std::vector<Leaf> leaves_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> positions_;
  std::vector<Split> splits_;  // by node id
  std::vector<Box> boxes_;     // by node id
};

// Squared distances (m^2), all added up as (dx^2 + dy^2) + dz^2. Rounding is monotonic: the distance to a box never
// exceeds the computed distance to any point in it.

/// From `query` to the points of a leaf; infinite in rows without a point.
inline Eigen::Array<double, KdTree::kLeafSize, 1> squared_distances(const KdTree::Leaf& leaf,
                                                                    const Eigen::Vector3d& query) {
  return (leaf.col(0) - query.x()).square() + (leaf.col(1) - query.y()).square() + (leaf.col(2) - query.z()).square();
}

/// Some rows of a leaf, the first `count` of `rows`.
struct LeafRows {
  std::array<std::uint32_t, KdTree::kLeafSize> rows;
  std::size_t count;
};

/// The rows of a leaf whose squared distance is `limit` at most. Without a branch: which rows these are is hard to
/// predict.
inline LeafRows rows_within(const Eigen::Array<double, KdTree::kLeafSize, 1>& squared_distances, double limit) {
  LeafRows found;
  found.count = 0;
  for (std::uint32_t row = 0; row < KdTree::kLeafSize; ++row) {
    found.rows[found.count] = row;
    found.count += squared_distances[row] <= limit ? 1 : 0;
  }
  return found;
}

/// The length of a difference vector.
inline double squared_length(const Eigen::Array3d& v) { return (v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]; }

/// From `point` to the box, 0 inside.
inline double squared_distance(const KdTree::Box& box, const Eigen::Vector3d& point) {
  return squared_length((box.lower - point.array()).max(point.array() - box.upper).max(0.0));
}

/// Between two boxes, 0 where they meet.
inline double squared_distance(const KdTree::Box& a, const KdTree::Box& b) {
  return squared_length((a.lower - b.upper).max(b.lower - a.upper).max(0.0));
}

}  // namespace dynamic_icp::spatial
