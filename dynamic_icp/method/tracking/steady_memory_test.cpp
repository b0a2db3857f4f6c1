// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
//
// In the long run the tracker asks the system for no memory at all.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "dynamic_icp/method/tracking/object_tracker.hpp"

#include "testing/boxes_in_view.hpp"
#include "testing/counted_allocations.hpp"

namespace dynamic_icp::tracking {
namespace {

constexpr int kRound = 40;  // scans after which traffic is where it was

/// Cars that come, turn, cross the line of sight and leave: one is born and one is lost in every round.
std::vector<MovingBox> rounds_of_traffic(double t) {
  const double in_round = std::fmod(t + 1e-6, kRound * kScanPeriod_s);
  const double yaw_rate = 2.0 * std::numbers::pi / (kRound * kScanPeriod_s);
  const double angle = -1.0 + yaw_rate * t;
  std::vector<MovingBox> boxes = {
      car(25 + 6 * std::cos(angle), 6 * std::sin(angle), angle + 0.5 * std::numbers::pi, 6 * yaw_rate, yaw_rate),
      car(45, -16 + 8 * in_round, 0.5 * std::numbers::pi, 8)};
  if (in_round < 1.0) {
    boxes.push_back(car(12 + 10 * in_round, -6, 0.0, 10));
  }
  return boxes;
}

TEST(TrackerMemory, NothingIsAllocatedInTheLongRun) {
  constexpr int kWarmUp = 4 * kRound;
  for (const int threads : {1, 2}) {
    ObjectTracker tracker{TrackerConfig{}};
    ScanPatches patches;
    const Workers workers(threads);
    std::size_t objects = 0;
    std::int64_t newest = 0;
    std::int64_t newest_before = 0;
    for (int k = 0; k < kWarmUp + 2 * kRound; ++k) {
      const double t = k * kScanPeriod_s;
      View view = view_of(rounds_of_traffic(t), t);
      const SensorMotion rest;
      const std::size_t before = allocation_count;
      patches.bound(view.scan, workers);
      tracker.flag_expected(view.scan, patches, view.radial, rest, workers, view.is_moving);
      tracker.clear_carrier(view.scan, patches, view.is_moving);
      const auto all = tracker.update(view.scan, view.radial, view.is_moving, rest, ground_from(rest.T_world_sensor),
                                      workers, Eigen::Matrix3d::Zero(), &patches);
      const std::size_t asked = allocation_count - before;
      for (const TrackedObject& object : all) {
        newest = std::max(newest, object.id);
      }
      if (k >= kWarmUp) {
        EXPECT_EQ(asked, 0u) << "scan " << k << " with " << threads << " threads";
        objects += all.size();
      } else if (k == 0) {
        EXPECT_GT(asked, 0u) << "the count sees the first scan";
        continue;
      }
      newest_before = k == kWarmUp ? newest : newest_before;
    }
    EXPECT_GT(objects, 3u * kRound) << "there is something to track";
    EXPECT_GT(newest, newest_before) << "new tracks begin meanwhile";
  }
}

}  // namespace
}  // namespace dynamic_icp::tracking
