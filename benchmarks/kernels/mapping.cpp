// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/mapping/plane_map.hpp"
#include "dynamic_icp/method/odometry/config.hpp"

#include "benchmarks/kernels/counters.hpp"
#include "benchmarks/kernels/scans.hpp"

namespace dynamic_icp::kernels {
namespace {

/// One scan more in a map that has all of them: the scans come again and again, so the map stays as large as it is.
void plane_map_add(benchmark::State& state) {
  const Workers workers(static_cast<int>(state.range(0)));
  mapping::PlaneMap map = known_map();
  std::vector<std::vector<Eigen::Vector3d>> scans;
  std::size_t points = 0;
  for (std::size_t i = 0; i < kScans; ++i) {
    scans.push_back(still_in_world(known_scan(Sensor::kUsual, i)));
    points += scans.back().size() / kScans;
  }
  std::size_t next = 0;
  for ([[maybe_unused]] auto _ : state) {
    map.add(scans[next], known_scan(Sensor::kUsual, next).T_world_sensor.translation(), workers);
    next = (next + 1) % kScans;
  }
  // On each level a point finds its cell and adds to the moments (20). Every third has a cell of its own on average,
  // whose plane is fitted (some 400).
  const auto levels = static_cast<std::size_t>(odometry::WindowOdometryConfig{}.mapping.levels);
  count_each(state, points,
             {.bytes = levels * kPointBytes,
              .lines = levels * (1 + sizeof(mapping::Moments) / 64),
              .operations = levels * (26 + 400 / 3)});
}
BENCHMARK(plane_map_add)->Apply(one_and_two_threads);

void plane_map_find(benchmark::State& state) {
  const mapping::PlaneMap& map = known_map();
  const std::vector<Eigen::Vector3d> points = still_in_world(known_scan(Sensor::kUsual, kScans - 1));
  std::size_t found = 0;
  for ([[maybe_unused]] auto _ : state) {
    found = 0;
    for (const Eigen::Vector3d& point : points) {
      found += map.find(point) != nullptr ? 1 : 0;
    }
    benchmark::DoNotOptimize(found);
  }
  state.counters["found"] = static_cast<double>(found) / static_cast<double>(points.size());
  // A slot and a cell on each level that is asked, two of three on average.
  count_each(state, points.size(),
             {.bytes = kPointBytes, .lines = 2 * (1 + sizeof(mapping::Patch) / 64), .operations = 12});
}
BENCHMARK(plane_map_find)->UseRealTime()->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace dynamic_icp::kernels
