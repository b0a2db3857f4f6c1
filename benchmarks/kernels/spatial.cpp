// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/spatial/kd_tree.hpp"

#include "benchmarks/kernels/counters.hpp"
#include "benchmarks/kernels/scans.hpp"

namespace dynamic_icp::kernels {
namespace {

constexpr double kGate_m = 0.3;    // of the correspondences of preset paper
constexpr double kRadius_m = 2.0;  // of the normals
constexpr std::size_t kNeighbours = 30;

const Scan& target_of(const benchmark::State& state) { return known_scan(static_cast<Sensor>(state.range(0))).thinned; }

/// The next scan, as it lies in the target when the motion is known.
std::vector<Eigen::Vector3d> queries_of(const benchmark::State& state) {
  const KnownScan& target = known_scan(static_cast<Sensor>(state.range(0)));
  const KnownScan& source = known_scan(static_cast<Sensor>(state.range(0)), 1);
  const Eigen::Isometry3d T_target_source = target.T_world_sensor.inverse() * source.T_world_sensor;
  std::vector<Eigen::Vector3d> queries = source.thinned.points();
  for (Eigen::Vector3d& query : queries) {
    query = T_target_source * query;
  }
  return queries;
}

void kd_tree_build(benchmark::State& state) {
  const std::vector<Eigen::Vector3d>& points = target_of(state).points();
  const Workers workers(static_cast<int>(state.range(1)));
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(spatial::KdTree(points, workers));
  }
  // On each level every point is compared and moved.
  const std::size_t levels = levels_over(points.size() / spatial::KdTree::kLeafSize);
  count_each(state, points.size(), {.bytes = levels * 2 * kPointBytes, .operations = 2 * levels});
}
BENCHMARK(kd_tree_build)->Apply(sensors_and_threads);

void kd_tree_nearest(benchmark::State& state) {
  const spatial::KdTree tree(target_of(state).points());
  const std::vector<Eigen::Vector3d> queries = queries_of(state);
  for ([[maybe_unused]] auto _ : state) {
    for (const Eigen::Vector3d& query : queries) {
      benchmark::DoNotOptimize(tree.nearest(query, kGate_m));
    }
  }
  // Down the tree, a box at each level (6 comparisons and as many more for its distance), and one leaf.
  const std::size_t levels = levels_over(tree.leaf_count());
  count_each(state, queries.size(),
             {.bytes = kPointBytes,
              .lines = levels + sizeof(spatial::KdTree::Leaf) / 64,
              .operations = 12 * levels + 9 * spatial::KdTree::kLeafSize});
}
BENCHMARK(kd_tree_nearest)->Apply(all_sensors);

void kd_tree_nearest_30(benchmark::State& state) {
  const spatial::KdTree tree(target_of(state).points());
  const std::vector<Eigen::Vector3d> queries = queries_of(state);
  std::vector<spatial::Neighbour> found;
  for ([[maybe_unused]] auto _ : state) {
    for (const Eigen::Vector3d& query : queries) {
      tree.nearest_k(query, kNeighbours, kRadius_m, found);
      benchmark::DoNotOptimize(found.data());
    }
  }
  // Four leaves at least, and each neighbour finds its place among those found.
  const std::size_t levels = levels_over(tree.leaf_count());
  constexpr std::size_t kLeaves = 4;
  count_each(state, queries.size(),
             {.bytes = kPointBytes,
              .lines = levels + kLeaves * sizeof(spatial::KdTree::Leaf) / 64,
              .operations = 12 * levels + kLeaves * 9 * spatial::KdTree::kLeafSize + kNeighbours * 5});
}
BENCHMARK(kd_tree_nearest_30)->Apply(all_sensors);

}  // namespace
}  // namespace dynamic_icp::kernels
