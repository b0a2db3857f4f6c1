// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "dynamic_icp/method/ego_motion/support_plane.hpp"
#include "dynamic_icp/method/odometry/config.hpp"
#include "dynamic_icp/method/tracking/object_tracker.hpp"

#include "benchmarks/kernels/counters.hpp"
#include "benchmarks/kernels/scans.hpp"

namespace dynamic_icp::kernels {
namespace {

/// All scans of the drive one after the other, from a tracker that knows nothing.
void object_tracker(benchmark::State& state) {
  const Workers workers(static_cast<int>(state.range(0)));
  const auto config = odometry::WindowOdometryConfig{}.tracking;
  std::size_t points = 0;
  std::vector<std::optional<ego_motion::SupportPlane>> support;  // the odometry knows it before the tracker begins
  for (std::size_t i = 0; i < kScans; ++i) {
    points += known_scan(Sensor::kUsual, i).whole.size();
    support.push_back(ego_motion::find_support_plane(known_scan(Sensor::kUsual, i).whole.points()));
  }
  std::size_t tracks = 0;
  for ([[maybe_unused]] auto _ : state) {
    tracking::ObjectTracker tracker(config);
    for (std::size_t i = 0; i < kScans; ++i) {
      const KnownScan& scan = known_scan(Sensor::kUsual, i);
      tracks = tracker.update(scan.whole, scan.radial, scan.is_moving, scan.T_world_sensor, support[i], workers).size();
    }
  }
  state.counters["tracks"] = static_cast<double>(tracks);
  state.counters["scans"] = static_cast<double>(kScans);
  // Every point is drawn into the range image and looked at once by the tracks near it.
  count_each(state, points, {.bytes = 2 * kPointBytes + 9, .lines = 1, .operations = 30});
}
BENCHMARK(object_tracker)->Apply(one_and_two_threads);

/// The rows that the tracks of all scans but the last expect in that one.
void expected_rows(benchmark::State& state) {
  const Workers workers(static_cast<int>(state.range(0)));
  tracking::ObjectTracker tracker(odometry::WindowOdometryConfig{}.tracking);
  for (std::size_t i = 0; i + 1 < kScans; ++i) {
    const KnownScan& scan = known_scan(Sensor::kUsual, i);
    tracker.update(scan.whole, scan.radial, scan.is_moving, scan.T_world_sensor, {}, workers);
  }
  const KnownScan& last = known_scan(Sensor::kUsual, kScans - 1);
  std::vector<std::uint8_t> flags;
  for ([[maybe_unused]] auto _ : state) {
    flags.assign(last.whole.size(), 0);
    tracker.flag_expected(last.whole, last.radial, {last.T_world_sensor}, workers, flags);
  }
  state.counters["flagged"] = static_cast<double>(std::count(flags.begin(), flags.end(), 1));
  // Every point is looked at once, to see whether it is near a body.
  count_each(state, last.whole.size(), {.bytes = kPointBytes + 1, .lines = 0, .operations = 10});
}
BENCHMARK(expected_rows)->Apply(one_and_two_threads);

}  // namespace
}  // namespace dynamic_icp::kernels
