// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/base/parallel.hpp"

namespace dynamic_icp::dynamics {

struct CondensedTree;

/// HDBSCAN*: m_cs and m_s of the paper.
struct HdbscanConfig {
  int min_cluster_size = 30;
  int min_samples = 10;
  bool allow_single_cluster = false;
};

ConfigFields fields(HdbscanConfig& config);

struct HdbscanResult {
  std::vector<std::int32_t> labels;   ///< for each point its cluster, 0 .. cluster_count - 1, or -1 for noise
  std::vector<double> probabilities;  ///< for each point how firmly it belongs to its cluster, 0 .. 1; 0 for noise
  /// For each cluster how persistent it is, 0 .. 1: its stability over that of a cluster of as many points that all
  /// stay from lambda 0 to the largest lambda in the data. 1 for all clusters when that lambda is infinite.
  std::vector<double> stabilities;
  int cluster_count = 0;
};

/// Hierarchical density-based clustering by Campello, Moulavi and Sander, exact, with Euclidean distance and selection
/// by excess of mass.
///
/// Definition: lambda = 1 / d for the mutual reachability distance d of `mutual_reachability_tree`; the condensed tree
/// of `condense`; the clusters of `select_by_excess_of_mass`, without the root unless `allow_single_cluster`. A point
/// belongs to the selected cluster it was in when it dropped out of the hierarchy, with the probability
/// min(lambda_point, death) / death, where death is the largest lambda at which anything left that very cluster. If the
/// root is selected, only the points that stayed to its death belong to it. Fewer than
/// max(min_cluster_size, min_samples + 1) points are all noise.
///
/// Identical points have the same label and probability. More than min_samples of them have infinite lambda:
/// probability 1, and the other points of their cluster, infinitely less dense, probability 0.
///
/// Guarantees: the result depends on the set of points alone. Permuted points have permuted labels, and the number of
/// threads changes nothing. Clusters are numbered in the order of their lexicographically smallest points. Everything
/// is finite. Memory grows linearly with the number of points.
///
/// Throws UsageError when the configuration is out of range and DataError naming a point whose coordinates are not
/// finite or beyond 1e150.
///
/// `tree`, if given, takes the condensed tree, its points in the order of `points`; no clusters where all is noise for
/// lack of points.
HdbscanResult hdbscan(std::span<const Eigen::Vector3d> points, const HdbscanConfig& config, const Workers& workers,
                      CondensedTree* tree = nullptr);

/// The same in the plane.
HdbscanResult hdbscan(std::span<const Eigen::Vector2d> points, const HdbscanConfig& config, const Workers& workers,
                      CondensedTree* tree = nullptr);

}  // namespace dynamic_icp::dynamics
