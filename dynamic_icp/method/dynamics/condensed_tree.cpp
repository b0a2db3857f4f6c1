// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/dynamics/condensed_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "dynamic_icp/method/spatial/disjoint_sets.hpp"

namespace dynamic_icp::dynamics {
namespace {

/// One merge of the single linkage tree. Nodes 0 .. n - 1 are the points, node n + i is the outcome of merge i.
struct Merge {
  std::array<std::uint32_t, 2> children{};
  std::uint32_t size = 0;
};

std::vector<Merge> single_linkage(std::span<const ReachabilityEdge> edges) {
  const auto n = static_cast<std::uint32_t>(edges.size() + 1);
  spatial::DisjointSets sets(n);
  std::vector<std::uint32_t> node_of_set(n);
  std::iota(node_of_set.begin(), node_of_set.end(), std::uint32_t{0});
  std::vector<Merge> merges(edges.size());
  for (std::uint32_t i = 0; i < edges.size(); ++i) {
    const std::uint32_t a = sets.find(edges[i].first);
    const std::uint32_t b = sets.find(edges[i].second);
    merges[i] = {{node_of_set[a], node_of_set[b]}, sets.size(a) + sets.size(b)};
    sets.unite(a, b);
    node_of_set[sets.find(a)] = n + i;
  }
  return merges;
}

double density(const ReachabilityEdge& edge) {
  return edge.squared_weight > 0.0 ? 1.0 / std::sqrt(edge.squared_weight) : std::numeric_limits<double>::infinity();
}

/// Where a node of the single linkage tree stands when it is opened from above.
struct Placement {
  std::uint32_t cluster = 0;
  bool left = false;    // its points have left the cluster
  double lambda = 0.0;  // at which they left
};

/// Adds to each cluster what its rows of the condensed tree hold: points and child clusters that left it.
void sum_up(CondensedTree& tree) {
  const auto leave = [](CondensedTree::Cluster& cluster, double lambda, std::uint32_t size) {
    cluster.stability += (lambda - cluster.birth) * size;
    cluster.death = std::max(cluster.death, lambda);
  };
  for (std::size_t i = 0; i < tree.point_cluster.size(); ++i) {
    leave(tree.clusters[tree.point_cluster[i]], tree.point_lambda[i], 1);
  }
  for (std::size_t c = 1; c < tree.clusters.size(); ++c) {
    CondensedTree::Cluster& parent = tree.clusters[tree.clusters[c].parent];
    leave(parent, tree.clusters[c].birth, tree.clusters[c].size);
    parent.has_children = true;
  }
}

}  // namespace

CondensedTree condense(std::span<const ReachabilityEdge> edges, std::uint32_t min_cluster_size) {
  const std::vector<Merge> merges = single_linkage(edges);
  const auto n = static_cast<std::uint32_t>(edges.size() + 1);
  const auto size = [&](std::uint32_t node) { return node < n ? 1 : merges[node - n].size; };
  CondensedTree tree;
  tree.clusters.push_back({.size = n});
  std::vector<Placement> placements(n + merges.size());
  // Downwards from the root, the last merge: a merge has a greater number than those it is made of.
  for (std::size_t i = merges.size(); i-- > 0;) {
    const Placement here = placements[n + i];
    const double lambda = here.left ? here.lambda : density(edges[i]);
    const bool dissolves = here.left || std::isinf(lambda);
    const auto [a, b] = merges[i].children;
    const bool breaks = !dissolves && size(a) >= min_cluster_size && size(b) >= min_cluster_size;
    for (const std::uint32_t child : {a, b}) {
      placements[child] = {here.cluster, dissolves || size(child) < min_cluster_size, lambda};
      if (breaks) {
        placements[child].cluster = static_cast<std::uint32_t>(tree.clusters.size());
        tree.clusters.push_back({.parent = here.cluster, .size = size(child), .birth = lambda});
      }
    }
  }
  tree.point_cluster.reserve(n);
  tree.point_lambda.reserve(n);
  for (std::uint32_t point = 0; point < n; ++point) {
    tree.point_cluster.push_back(placements[point].cluster);
    tree.point_lambda.push_back(placements[point].lambda);
  }
  sum_up(tree);
  return tree;
}

std::vector<bool> select_by_excess_of_mass(const CondensedTree& tree, bool allow_root) {
  const std::size_t count = tree.clusters.size();
  std::vector<bool> selected(count, false);
  std::vector<double> below(count, 0.0);  // stability of the best choice among the descendants
  for (std::size_t c = count; c-- > 0;) {
    const CondensedTree::Cluster& cluster = tree.clusters[c];
    selected[c] = (c > 0 || allow_root) && !(below[c] > cluster.stability);
    if (c > 0) {
      below[cluster.parent] += selected[c] ? cluster.stability : below[c];
    }
  }
  std::vector<bool> covered(count, false);  // lies in a selected cluster
  for (std::size_t c = 1; c < count; ++c) {
    const std::uint32_t parent = tree.clusters[c].parent;
    covered[c] = covered[parent] || selected[parent];
    selected[c] = selected[c] && !covered[c];
  }
  return selected;
}

}  // namespace dynamic_icp::dynamics
