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

/// As far as instant scans need it.
tracking::SensorMotion motion_of(const KnownScan& scan) {
  return tracking::motion_at(scan.T_world_sensor, Eigen::Vector3d::Zero(), scan.velocity_sensor);
}

/// All scans of the drive one after the other, from a tracker that knows nothing. Their patches are known, which it
/// asks for other things before.
void object_tracker(benchmark::State& state) {
  const Workers workers(static_cast<int>(state.range(0)));
  const auto config = odometry::WindowOdometryConfig{}.tracking;
  std::size_t points = 0;
  // The odometry knows these before the tracker begins.
  std::vector<std::optional<ego_motion::SupportPlane>> support;
  std::vector<tracking::ScanPatches> patches(kScans);
  for (std::size_t i = 0; i < kScans; ++i) {
    patches[i].bound(known_scan(Sensor::kUsual, i).whole, workers);
    points += known_scan(Sensor::kUsual, i).whole.size();
    support.push_back(ego_motion::find_support_plane(known_scan(Sensor::kUsual, i).whole.points()));
  }
  std::size_t tracks = 0;
  for ([[maybe_unused]] auto _ : state) {
    tracking::ObjectTracker tracker(config);
    for (std::size_t i = 0; i < kScans; ++i) {
      const KnownScan& scan = known_scan(Sensor::kUsual, i);
      tracks = tracker
                   .update(scan.whole, scan.radial, scan.is_moving, motion_of(scan), support[i], workers,
                           Eigen::Matrix3d::Zero(), &patches[i])
                   .size();
    }
  }
  state.counters["tracks"] = static_cast<double>(tracks);
  state.counters["scans"] = static_cast<double>(kScans);
  // The radial velocity and the flag of every point are looked at, and the points near tracks.
  count_each(state, points, {.bytes = 9, .lines = 0, .operations = 2});
}
BENCHMARK(object_tracker)->Apply(one_and_two_threads);

/// The rows that the tracks of all scans but the last expect in that one, whose patches are known.
void expected_rows(benchmark::State& state) {
  const Workers workers(static_cast<int>(state.range(0)));
  tracking::ObjectTracker tracker(odometry::WindowOdometryConfig{}.tracking);
  for (std::size_t i = 0; i + 1 < kScans; ++i) {
    const KnownScan& scan = known_scan(Sensor::kUsual, i);
    tracker.update(scan.whole, scan.radial, scan.is_moving, motion_of(scan), {}, workers);
  }
  const KnownScan& last = known_scan(Sensor::kUsual, kScans - 1);
  tracking::ScanPatches patches;
  patches.bound(last.whole, workers);
  std::vector<std::uint8_t> flags;
  for ([[maybe_unused]] auto _ : state) {
    flags.assign(last.whole.size(), 0);
    tracker.flag_expected(last.whole, patches, last.radial, motion_of(last), workers, flags);
  }
  state.counters["flagged"] = static_cast<double>(std::count(flags.begin(), flags.end(), 1));
  // Only the points near bodies are looked at, but the flags of all are cleared.
  count_each(state, last.whole.size(), {.bytes = 1, .lines = 0, .operations = 1});
}
BENCHMARK(expected_rows)->Apply(one_and_two_threads);

/// What the tracker asks several times a scan.
void scan_patches(benchmark::State& state) {
  const Workers workers(static_cast<int>(state.range(0)));
  const Scan& scan = known_scan(Sensor::kUsual, 0).whole;
  tracking::ScanPatches patches;
  for ([[maybe_unused]] auto _ : state) {
    patches.bound(scan, workers);
    benchmark::DoNotOptimize(patches.blocks().data());
  }
  // Every point is looked at once.
  count_each(state, scan.size(), {.bytes = kPointBytes, .lines = 0, .operations = 10});
}
BENCHMARK(scan_patches)->Apply(one_and_two_threads);

}  // namespace
}  // namespace dynamic_icp::kernels
