// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/dynamics/hdbscan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/dynamics/condensed_tree.hpp"
#include "dynamic_icp/method/dynamics/mutual_reachability.hpp"
#include "dynamic_icp/method/spatial/kd_tree.hpp"

namespace dynamic_icp::dynamics {
namespace {

constexpr std::int32_t kNoise = -1;
constexpr std::uint32_t kNoCluster = std::numeric_limits<std::uint32_t>::max();

void check(std::span<const Eigen::Vector3d> points, const HdbscanConfig& config) {
  HdbscanConfig copy = config;
  check_fields(fields(copy));
  for (std::size_t i = 0; i < points.size(); ++i) {
    // Written so that NaN fails. The tree checks too, but knows the points in another order.
    if (!(points[i].cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= spatial::KdTree::kLargestCoordinate_m)) {
      throw DataError("point " + std::to_string(i) + " to be clustered has a coordinate not finite or beyond 1e150 m");
    }
  }
}

/// The points in lexicographic order: whatever is computed from them cannot depend on the order they came in.
std::vector<std::uint32_t> lexicographic_order(std::span<const Eigen::Vector3d> points) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    const Eigen::Vector3d& a = points[i];
    const Eigen::Vector3d& b = points[j];
    return std::tie(a.x(), a.y(), a.z(), i) < std::tie(b.x(), b.y(), b.z(), j);
  });
  return order;
}

/// For each cluster the selected cluster it lies in, or kNoCluster.
std::vector<std::uint32_t> selected_ancestors(const CondensedTree& tree, const std::vector<bool>& selected) {
  std::vector<std::uint32_t> ancestors(tree.clusters.size(), kNoCluster);
  for (std::uint32_t c = 0; c < ancestors.size(); ++c) {
    ancestors[c] = selected[c] ? c : (c > 0 ? ancestors[tree.clusters[c].parent] : kNoCluster);
  }
  return ancestors;
}

double probability(double lambda, double death) {
  return death == 0.0 || std::isinf(lambda) ? 1.0 : std::min(lambda, death) / death;
}

/// Stabilities scaled to 0 .. 1, in the order of the labels.
std::vector<double> persistences(const CondensedTree& tree, const std::vector<std::uint32_t>& clusters,
                                 std::span<const std::int32_t> labels) {
  const double largest = *std::max_element(tree.point_lambda.begin(), tree.point_lambda.end());
  std::vector<double> result;
  for (std::size_t label = 0; label < clusters.size(); ++label) {
    const auto size = static_cast<double>(std::count(labels.begin(), labels.end(), static_cast<std::int32_t>(label)));
    const bool measurable = std::isfinite(largest) && largest > 0.0;
    result.push_back(measurable ? tree.clusters[clusters[label]].stability / (size * largest) : 1.0);
  }
  return result;
}

/// Labels and probabilities go to the rows the sorted points came from.
HdbscanResult label(const CondensedTree& tree, const std::vector<bool>& selected, std::span<const std::uint32_t> rows) {
  HdbscanResult result;
  result.labels.assign(rows.size(), kNoise);
  result.probabilities.assign(rows.size(), 0.0);
  const std::vector<std::uint32_t> ancestors = selected_ancestors(tree, selected);
  std::vector<std::int32_t> label_of(tree.clusters.size(), kNoise);
  std::vector<std::uint32_t> clusters;  // by label
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::uint32_t cluster = ancestors[tree.point_cluster[i]];
    if (cluster == kNoCluster || (cluster == 0 && tree.point_lambda[i] < tree.clusters[0].death)) {
      continue;
    }
    if (label_of[cluster] == kNoise) {
      label_of[cluster] = static_cast<std::int32_t>(clusters.size());
      clusters.push_back(cluster);
    }
    result.labels[rows[i]] = label_of[cluster];
    result.probabilities[rows[i]] = probability(tree.point_lambda[i], tree.clusters[cluster].death);
  }
  result.stabilities = persistences(tree, clusters, result.labels);
  result.cluster_count = static_cast<int>(clusters.size());
  return result;
}

/// The tree of sorted points with its points in the order of the rows that they came from.
CondensedTree in_order_of_rows(CondensedTree tree, std::span<const std::uint32_t> rows) {
  const CondensedTree sorted = tree;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    tree.point_cluster[rows[i]] = sorted.point_cluster[i];
    tree.point_lambda[rows[i]] = sorted.point_lambda[i];
  }
  return tree;
}

}  // namespace

ConfigFields fields(HdbscanConfig& config) {
  return {
      {"min_cluster_size", &config.min_cluster_size, 2, 1e9, "points", "smallest group of points that is a cluster"},
      {"min_samples", &config.min_samples, 1, 1e6, "points",
       "neighbours that count in the density around a point; more means smoother densities and more noise"},
      {"allow_single_cluster", &config.allow_single_cluster, 0, 0, "",
       "whether all points together may be one cluster"}};
}

HdbscanResult hdbscan(std::span<const Eigen::Vector3d> points, const HdbscanConfig& config, const Workers& workers,
                      CondensedTree* tree_out) {
  check(points, config);
  const auto fewest = static_cast<std::size_t>(std::max(config.min_cluster_size, config.min_samples + 1));
  if (points.size() < fewest) {
    if (tree_out != nullptr) {
      *tree_out = {};
    }
    HdbscanResult noise;
    noise.labels.assign(points.size(), kNoise);
    noise.probabilities.assign(points.size(), 0.0);
    return noise;
  }
  const std::vector<std::uint32_t> rows = lexicographic_order(points);
  std::vector<Eigen::Vector3d> sorted(points.size());
  std::transform(rows.begin(), rows.end(), sorted.begin(), [&](std::uint32_t row) { return points[row]; });
  const auto edges = mutual_reachability_tree(sorted, config.min_samples, workers);
  CondensedTree tree = condense(edges, static_cast<std::uint32_t>(config.min_cluster_size));
  HdbscanResult result = label(tree, select_by_excess_of_mass(tree, config.allow_single_cluster), rows);
  if (tree_out != nullptr) {
    *tree_out = in_order_of_rows(std::move(tree), rows);
  }
  return result;
}

HdbscanResult hdbscan(std::span<const Eigen::Vector2d> points, const HdbscanConfig& config, const Workers& workers,
                      CondensedTree* tree) {
  std::vector<Eigen::Vector3d> in_space(points.size());
  std::transform(points.begin(), points.end(), in_space.begin(),
                 [](const Eigen::Vector2d& p) { return Eigen::Vector3d(p.x(), p.y(), 0.0); });
  return hdbscan(in_space, config, workers, tree);
}

}  // namespace dynamic_icp::dynamics
