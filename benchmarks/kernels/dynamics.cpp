// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/dynamics/hdbscan.hpp"

#include "benchmarks/kernels/counters.hpp"
#include "benchmarks/kernels/scans.hpp"

namespace dynamic_icp::kernels {
namespace {

/// Points of the scan as read, evenly spread: denser than the moving points of a thinned scan, of which there are some
/// hundreds to a few thousand.
void hdbscan(benchmark::State& state) {
  const std::vector<Eigen::Vector3d> points = spread_points(static_cast<std::size_t>(state.range(0)));
  const Workers workers(static_cast<int>(state.range(1)));
  dynamics::HdbscanConfig config;
  config.min_cluster_size = 30;
  config.min_samples = 10;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(dynamics::hdbscan(points, config, workers));
  }
  // Core distances: a search as for normals. Spanning tree: each point meets its neighbours in every round, of which
  // there are at most log2(n); four are usual.
  constexpr std::size_t kRounds = 4;
  const auto neighbours = static_cast<std::size_t>(config.min_samples);
  count_each(
      state, points.size(),
      {.bytes = kPointBytes + 12, .lines = 24 + kRounds * neighbours, .operations = 600 + kRounds * 9 * neighbours});
}
BENCHMARK(hdbscan)
    ->ArgNames({"points", "threads"})
    ->ArgsProduct({{2000, 10000, 50000}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace dynamic_icp::kernels
