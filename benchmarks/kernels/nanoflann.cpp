// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// nanoflann beside spatial/kd_tree: the same points, the same queries, leaves of the same size.
#include <cstdint>
#include <vector>

#include <nanoflann.hpp>

#include "benchmarks/kernels/counters.hpp"
#include "benchmarks/kernels/scans.hpp"

namespace dynamic_icp::kernels {
namespace {

struct Cloud {
  const std::vector<Eigen::Vector3d>& points;

  // The names nanoflann asks for.
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3, std::uint32_t>;

constexpr std::size_t kLeafSize = 16;
constexpr std::size_t kNeighbours = 30;

Sensor sensor_of(const benchmark::State& state) { return static_cast<Sensor>(state.range(0)); }

std::vector<Eigen::Vector3d> queries_of(const benchmark::State& state) {
  const KnownScan& target = known_scan(sensor_of(state));
  const KnownScan& source = known_scan(sensor_of(state), 1);
  std::vector<Eigen::Vector3d> queries = source.thinned.points();
  for (Eigen::Vector3d& query : queries) {
    query = target.T_world_sensor.inverse() * source.T_world_sensor * query;
  }
  return queries;
}

void nanoflann_build(benchmark::State& state) {
  const Cloud cloud{known_scan(sensor_of(state)).thinned.points()};
  for ([[maybe_unused]] auto _ : state) {
    Tree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize));
    tree.buildIndex();
    benchmark::ClobberMemory();
  }
  count_each(state, cloud.points.size(), {.bytes = kPointBytes});
}
BENCHMARK(nanoflann_build)->Apply(all_sensors);

/// `neighbours` of each query, however far.
void search(benchmark::State& state, std::size_t neighbours) {
  const Cloud cloud{known_scan(sensor_of(state)).thinned.points()};
  Tree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize));
  tree.buildIndex();
  const std::vector<Eigen::Vector3d> queries = queries_of(state);
  std::vector<std::uint32_t> rows(neighbours);
  std::vector<double> squared(neighbours);
  for ([[maybe_unused]] auto _ : state) {
    for (const Eigen::Vector3d& query : queries) {
      benchmark::DoNotOptimize(tree.knnSearch(query.data(), neighbours, rows.data(), squared.data()));
    }
  }
  count_each(state, queries.size(), {.bytes = kPointBytes});
}

void nanoflann_nearest(benchmark::State& state) { search(state, 1); }
BENCHMARK(nanoflann_nearest)->Apply(all_sensors);

void nanoflann_nearest_30(benchmark::State& state) { search(state, kNeighbours); }
BENCHMARK(nanoflann_nearest_30)->Apply(all_sensors);

}  // namespace
}  // namespace dynamic_icp::kernels
