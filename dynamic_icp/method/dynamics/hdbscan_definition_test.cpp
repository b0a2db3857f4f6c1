// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// The clustering against its definition, as slow and as literal as possible.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

#include "dynamic_icp/method/dynamics/hdbscan.hpp"

#include "testing/random_points.hpp"

namespace dynamic_icp::dynamics {
namespace {

using Members = std::vector<std::size_t>;

constexpr double kFar = std::numeric_limits<double>::infinity();

struct Link {
  double weight;
  double length;
  std::size_t first;
  std::size_t second;
};

/// Minimum spanning tree of the full matrix of mutual reachability distances, by Prim's algorithm. Of links of equal
/// weight the shorter comes first, then the one between lexicographically smaller points.
std::vector<Link> matrix_tree(const Points& points, std::size_t min_samples) {
  const std::size_t n = points.size();
  std::vector<std::vector<double>> distance(n, std::vector<double>(n));
  std::vector<double> core(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      distance[i][j] = (points[i] - points[j]).norm();
    }
    std::vector<double> row = distance[i];
    std::sort(row.begin(), row.end());
    core[i] = row[min_samples];  // row[0] is the point itself
  }
  const auto order = [&](const Link& link) {
    const auto& a = points[link.first];
    const auto& b = points[link.second];
    const std::tuple key_a(a.x(), a.y(), a.z(), link.first);
    const std::tuple key_b(b.x(), b.y(), b.z(), link.second);
    return std::tuple(link.weight, link.length, std::min(key_a, key_b), std::max(key_a, key_b));
  };
  std::vector<Link> best(n, Link{kFar, kFar, 0, 0});
  std::vector<bool> inside(n, false);
  std::vector<Link> tree;
  for (std::size_t last = 0; tree.size() + 1 < n;) {
    inside[last] = true;
    std::size_t next = n;
    for (std::size_t j = 0; j < n; ++j) {
      const Link link{std::max({core[last], core[j], distance[last][j]}), distance[last][j], last, j};
      if (!inside[j] && order(link) < order(best[j])) {
        best[j] = link;
      }
      if (!inside[j] && (next == n || order(best[j]) < order(best[next]))) {
        next = j;
      }
    }
    tree.push_back(best[next]);
    last = next;
  }
  std::sort(tree.begin(), tree.end(), [&](const Link& a, const Link& b) { return order(a) < order(b); });
  return tree;
}

/// Those of `members` that the first `count` links join to `start`.
Members joined(const std::vector<Link>& tree, std::size_t count, std::size_t start) {
  Members reached{start};
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (std::size_t k = 0; k < count; ++k) {
      for (const auto& [from, to] : {std::pair(tree[k].first, tree[k].second), {tree[k].second, tree[k].first}}) {
        if (from == reached[i] && std::find(reached.begin(), reached.end(), to) == reached.end()) {
          reached.push_back(to);
        }
      }
    }
  }
  return reached;
}

struct NaiveCluster {
  std::size_t parent = 0;
  double birth = 0.0;
  double death = 0.0;
  double stability = 0.0;
  std::vector<std::size_t> children;
  bool selected = false;
};

struct NaiveTree {
  std::vector<NaiveCluster> clusters{1};
  std::vector<std::size_t> cluster;  // by point
  std::vector<double> lambda;        // by point
};

/// Cuts the links from the heaviest to the lightest and follows what becomes of the parts.
NaiveTree naive_condensed_tree(const std::vector<Link>& tree, std::size_t min_cluster_size) {
  const std::size_t n = tree.size() + 1;
  NaiveTree result;
  result.cluster.assign(n, 0);
  result.lambda.assign(n, -1.0);  // still there
  const auto leave = [&](const Members& members, double lambda) {
    for (const std::size_t point : members) {
      NaiveCluster& from = result.clusters[result.cluster[point]];
      result.lambda[point] = lambda;
      from.stability += lambda - from.birth;
      from.death = std::max(from.death, lambda);
    }
  };
  for (std::size_t k = tree.size(); k-- > 0;) {
    if (result.lambda[tree[k].first] >= 0.0) {
      continue;
    }
    const double lambda = 1.0 / tree[k].weight;  // infinite for identical points
    const Members a = joined(tree, k, tree[k].first);
    const Members b = joined(tree, k, tree[k].second);
    if (a.size() >= min_cluster_size && b.size() >= min_cluster_size && tree[k].weight > 0.0) {
      const std::size_t parent = result.cluster[tree[k].first];
      for (const Members& part : {a, b}) {
        const std::size_t child = result.clusters.size();
        NaiveCluster& from = result.clusters[parent];
        from.children.push_back(child);
        from.stability += static_cast<double>(part.size()) * (lambda - from.birth);
        from.death = std::max(from.death, lambda);
        for (const std::size_t point : part) {
          result.cluster[point] = child;
        }
        result.clusters.push_back({.parent = parent, .birth = lambda, .children = {}});
      }
      continue;
    }
    for (const Members& part : {a, b}) {
      if (part.size() < min_cluster_size || tree[k].weight == 0.0) {
        leave(part, lambda);
      }
    }
  }
  return result;
}

/// Selects among the descendants of `cluster` and itself; returns their stability.
double naive_select(NaiveTree& tree, std::size_t cluster, bool allow_root) {
  double below = 0.0;
  for (const std::size_t child : tree.clusters[cluster].children) {
    below += naive_select(tree, child, allow_root);
  }
  if (below > tree.clusters[cluster].stability || (cluster == 0 && !allow_root)) {
    return below;
  }
  const std::function<void(std::size_t)> deselect = [&](std::size_t c) {
    tree.clusters[c].selected = false;
    for (const std::size_t child : tree.clusters[c].children) {
      deselect(child);
    }
  };
  deselect(cluster);
  tree.clusters[cluster].selected = true;
  return tree.clusters[cluster].stability;
}

struct NaiveResult {
  std::vector<std::int64_t> clusters;  // by point: any number that distinguishes the clusters, -1 for noise
  std::vector<double> probabilities;
  std::map<std::int64_t, double> stabilities;
};

NaiveResult naive_hdbscan(const Points& points, const HdbscanConfig& config) {
  const auto tree = matrix_tree(points, static_cast<std::size_t>(config.min_samples));
  NaiveTree condensed = naive_condensed_tree(tree, static_cast<std::size_t>(config.min_cluster_size));
  naive_select(condensed, 0, config.allow_single_cluster);
  const double largest = *std::max_element(condensed.lambda.begin(), condensed.lambda.end());
  NaiveResult result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::size_t c = condensed.cluster[i];
    while (c != 0 && !condensed.clusters[c].selected) {
      c = condensed.clusters[c].parent;
    }
    const NaiveCluster& cluster = condensed.clusters[c];
    const bool belongs = cluster.selected && (c != 0 || condensed.lambda[i] >= cluster.death);
    result.clusters.push_back(belongs ? static_cast<std::int64_t>(c) : -1);
    const double share = std::isinf(condensed.lambda[i]) ? 1.0 : std::min(condensed.lambda[i] / cluster.death, 1.0);
    result.probabilities.push_back(belongs ? share : 0.0);
  }
  for (const std::int64_t c : result.clusters) {
    const auto size = static_cast<double>(std::count(result.clusters.begin(), result.clusters.end(), c));
    if (c >= 0) {
      const double stability = condensed.clusters[static_cast<std::size_t>(c)].stability;
      result.stabilities[c] = std::isinf(largest) ? 1.0 : stability / (size * largest);
    }
  }
  return result;
}

void expect_definition(const Points& points, const HdbscanConfig& config) {
  const HdbscanResult result = hdbscan(points, config, Workers(1));
  const NaiveResult expected = naive_hdbscan(points, config);
  ASSERT_EQ(result.labels.size(), points.size());
  ASSERT_EQ(result.probabilities.size(), points.size());
  ASSERT_EQ(result.stabilities.size(), expected.stabilities.size());
  ASSERT_EQ(static_cast<std::size_t>(result.cluster_count), expected.stabilities.size());
  std::map<std::int64_t, std::int32_t> renamed;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (expected.clusters[i] < 0) {
      ASSERT_EQ(result.labels[i], -1) << "point " << i;
    } else {
      const std::int32_t label = renamed.emplace(expected.clusters[i], result.labels[i]).first->second;
      ASSERT_EQ(result.labels[i], label) << "point " << i;
      ASSERT_GE(label, 0);
      ASSERT_LT(label, result.cluster_count);
    }
    ASSERT_NEAR(result.probabilities[i], expected.probabilities[i], 1e-9) << "point " << i;
  }
  for (const auto& [cluster, label] : renamed) {
    ASSERT_NEAR(result.stabilities[static_cast<std::size_t>(label)], expected.stabilities.at(cluster), 1e-9);
  }
}

TEST(Hdbscan, FollowsTheDefinitionOnRandomSets) {
  std::mt19937 random(1);
  for (int repeat = 0; repeat < 45; ++repeat) {
    const std::size_t n = 40 + random() % 110;
    const std::vector<Points> sets{blobs(random, n), flat(blobs(random, n)), lines(random, n),
                                   with_duplicates(random, n), Points()};
    const HdbscanConfig config{.min_cluster_size = static_cast<int>(2 + random() % 25),
                               .min_samples = static_cast<int>(1 + random() % 12),
                               .allow_single_cluster = repeat % 4 == 0};
    for (std::size_t kind = 0; kind < sets.size(); ++kind) {
      SCOPED_TRACE(::testing::Message() << "repeat " << repeat << " kind " << kind);
      Points points = sets[kind];
      while (points.size() < n) {
        points.push_back(in_cube(random, 3.0));
      }
      ASSERT_NO_FATAL_FAILURE(expect_definition(points, config));
    }
  }
}

TEST(Hdbscan, FollowsTheDefinitionWithTheConfigurationOfThePaper) {
  std::mt19937 random(2);
  for (int repeat = 0; repeat < 4; ++repeat) {
    ASSERT_NO_FATAL_FAILURE(expect_definition(blobs(random, 300), HdbscanConfig{}));
  }
}

TEST(Hdbscan, FollowsTheDefinitionWhereDistancesTie) {
  // Neighbours on the grid have equal weights by the hundred; the order of coordinates decides.
  for (const HdbscanConfig config : {HdbscanConfig{3, 2, false}, {8, 5, false}, {5, 10, true}}) {
    Points points;
    for (int i = 0; i < 150; ++i) {
      points.emplace_back(i % 15 + (i % 15 > 8 ? 2.0 : 0.0), i / 15, 0.0);
    }
    ASSERT_NO_FATAL_FAILURE(expect_definition(points, config));
  }
}

}  // namespace
}  // namespace dynamic_icp::dynamics
