// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dynamic_icp/method/dynamics/mutual_reachability.hpp"

namespace dynamic_icp::dynamics {

/// The hierarchy of clusters that a falling distance threshold leaves of n points, seen from the top: at first all
/// points are one cluster, number 0; as the threshold falls, points drop out of their cluster, and where a cluster
/// breaks into two parts of at least the minimum size, the parts are clusters of their own. Density lambda (1/m) is
/// one over the threshold.
struct CondensedTree {
  struct Cluster {
    std::uint32_t parent = 0;  ///< smaller than the cluster's own number; 0 for cluster 0
    std::uint32_t size = 0;    ///< points at birth
    double birth = 0.0;        ///< lambda at which it parted from its parent; finite, 0 for cluster 0
    double death = 0.0;        ///< lambda at which the last points left it or it broke in two; may be infinite
    double stability = 0.0;    ///< sum over its points of (lambda at leaving - birth); may be infinite
    bool has_children = false;
  };

  std::vector<Cluster> clusters;             ///< parents before children
  std::vector<std::uint32_t> point_cluster;  ///< for each point the smallest cluster it was in
  std::vector<double> point_lambda;          ///< and the lambda at which it dropped out of that; may be infinite
};

/// Condenses the single linkage tree that `edges`, the sorted spanning tree of edges.size() + 1 points, describes.
///
/// Points at mutual reachability distance 0 are never parted: they leave their cluster together at infinite lambda.
/// So every birth is finite, and differences of lambdas are never NaN.
/// Needs `min_cluster_size` >= 2 and at least one edge. Costs O(n), without recursion.
CondensedTree condense(std::span<const ReachabilityEdge> edges, std::uint32_t min_cluster_size);

/// The clusters with the largest total stability of which none contains another (excess of mass), as a flag for each
/// cluster. A cluster gives way to its descendants only if they are strictly more stable in total. Cluster 0 takes
/// part only if `allow_root`.
std::vector<bool> select_by_excess_of_mass(const CondensedTree& tree, bool allow_root);

}  // namespace dynamic_icp::dynamics
