// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dynamic_icp/method/spatial/kd_tree.hpp"
#include "dynamic_icp/method/spatial/nearby_leaves.hpp"

namespace dynamic_icp::spatial {

/// Nearest neighbours of the points of a tree among themselves, a leaf at a time: its points walk the tree together,
/// and what one of them has found bounds the search of the next. Several times faster than a search for each point.
///
/// The neighbours of a point are those that `KdTree::nearest_k` finds: the `k` nearest at distance <= `max_distance_m`,
/// the point itself or a twin of it among them, of equal distances the smallest index. Their order is another.
/// An object serves one thread; the tree must outlive it.
class Neighbourhoods {
 public:
  Neighbourhoods(const KdTree& tree, std::size_t k, double max_distance_m);

  /// Searches around the points of one leaf. Fastest for one leaf after the next.
  void search(std::size_t leaf);

  /// Points of the leaf searched last.
  [[nodiscard]] std::size_t rows() const { return rows_; }
  /// Positions in the tree of the neighbours of a row of that leaf, and their squared distances (m^2) in the same
  /// order. It depends on the points and on the leaves searched before, but on nothing else.
  [[nodiscard]] std::span<const std::uint32_t> positions(std::size_t row) const {
    return {&found_positions_[row * stride_], counts_[row]};
  }
  [[nodiscard]] std::span<const double> squared_distances(std::size_t row) const {
    return {&found_squared_[row * stride_], counts_[row]};
  }

 private:
  static constexpr std::size_t kLeafSize = KdTree::kLeafSize;
  using LeafValues = std::array<double, kLeafSize>;

  [[nodiscard]] Eigen::Vector3d point(std::size_t leaf, std::size_t row) const {
    return tree_.leaf(leaf).row(static_cast<Eigen::Index>(row)).transpose();
  }
  void search_one_by_one(std::size_t leaf);
  void search_alone(std::size_t leaf, std::size_t row);
  void forget_rows();
  void know_row(std::size_t row, double squared_distance);
  [[nodiscard]] double bound_by_known_rows(const Eigen::Vector3d& p) const;
  void bound_by_leaf_before(std::size_t leaf);
  void bound_by_own_leaf(std::size_t leaf);
  bool list_leaves(std::size_t leaf);
  void search_listed(std::size_t leaf, std::size_t row);
  void collect(const Eigen::Vector3d& query, double limit);
  void keep_nearest(std::size_t row);
  void keep_nearest_by_index(std::size_t row);

  const KdTree& tree_;
  std::size_t k_;
  double max_distance_m_;
  double squared_gate_;
  std::size_t stride_;

  std::size_t rows_ = 0;
  std::size_t leaf_ = 0;
  LeafValues bounds_{};  ///< m^2, by row: all neighbours are within; the gate where nothing better is known
  // By row of the leaf searched last, as far as it has been.
  LeafValues reached_{};      ///< m, k points are within
  LeafValues not_reached_{};  ///< infinite where that is not known, else 0
  std::array<std::size_t, kLeafSize> counts_{};
  std::vector<double> found_squared_;
  std::vector<std::uint32_t> found_positions_;

  NearbyLeaves listed_;  ///< in reach of any row of the leaf
  // Candidates of one row.
  std::size_t candidates_ = 0;
  std::vector<double> squared_;
  std::vector<std::uint32_t> positions_;
  std::vector<Neighbour> alone_;
};

}  // namespace dynamic_icp::spatial
