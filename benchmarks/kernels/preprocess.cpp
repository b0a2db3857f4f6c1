// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/config.hpp"

#include "benchmarks/kernels/counters.hpp"
#include "benchmarks/kernels/scans.hpp"

namespace dynamic_icp::kernels {
namespace {

Sensor sensor_of(const benchmark::State& state) { return static_cast<Sensor>(state.range(0)); }

void assign(benchmark::State& state) {
  const RawScan& raw = known_scan(sensor_of(state)).raw;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(Scan::from_raw(raw));
  }
  // The length of each point and its direction.
  count_each(state, raw.points.size(), {.bytes = kPointBytes + 8 + kRowBytes, .operations = 12});
}
BENCHMARK(assign)->Apply(all_sensors);

void crop_range(benchmark::State& state) {
  const Scan scan = Scan::from_raw(known_scan(sensor_of(state)).raw);
  const auto config = odometry::WindowOdometryConfig{}.preprocess.range;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(preprocess::crop_range(scan, config));
  }
  count_each(state, scan.size(), {.bytes = 2 * kRowBytes, .operations = 6});
}
BENCHMARK(crop_range)->Apply(all_sensors);

void voxel_grid(benchmark::State& state) {
  const KnownScan& known = known_scan(sensor_of(state));
  const auto config = odometry::WindowOdometryConfig{}.preprocess.voxel;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(preprocess::voxel_grid(known.whole, config));
  }
  const std::size_t points = known.whole.size();
  // The voxel of each point, and a look whether it is taken; what is kept is copied.
  count(state, {points, points * kPointBytes + known.thinned.size() * 2 * kRowBytes, points, 6 * points});
}
BENCHMARK(voxel_grid)->Apply(all_sensors);

void normals(benchmark::State& state) {
  const Scan& scan = known_scan(sensor_of(state)).thinned;
  const Workers workers(static_cast<int>(state.range(1)));
  const spatial::KdTree tree(scan.points());
  const auto config = preprocess::NormalsConfig{};
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(preprocess::estimate_normals(scan.points(), tree, config, workers));
  }
  // Each point looks at the leaves its neighbours lie in, four at least, sums up their scatter (18 each) and finds its
  // axes (some 300).
  const auto neighbours = static_cast<std::size_t>(config.max_neighbours);
  constexpr std::size_t kLeaves = 4;
  count_each(state, scan.size(),
             {.bytes = 2 * kPointBytes,
              .lines = kLeaves * sizeof(spatial::KdTree::Leaf) / 64,
              .operations = kLeaves * spatial::KdTree::kLeafSize * 9 + neighbours * 18 + 300});
}
BENCHMARK(normals)->Apply(sensors_and_threads);

}  // namespace
}  // namespace dynamic_icp::kernels
