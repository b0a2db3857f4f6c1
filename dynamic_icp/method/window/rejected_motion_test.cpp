// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// A motion that is not believed says nothing of the sensor.
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/window/window_estimator.hpp"

#include "testing/one_thread.hpp"
#include "testing/swept_room.hpp"

namespace dynamic_icp::window {
namespace {

using Eigen::Vector3d;

constexpr double kScanPeriod_s = 0.1;
const Vector3d kAhead(2.0, 0.0, 0.0);  // m/s, what the Doppler says
const Vector3d kAside(2.0, 0.3, 0.0);  // m/s, what the planes say

/// A hall as a sensor without rotation sees it that has moved at `velocity`; the Doppler is that of kAhead.
Scan hall_seen(int k, const Vector3d& velocity) {
  std::mt19937 random(static_cast<unsigned>(50 + k));
  std::normal_distribution<double> normal;
  RawScan raw;
  for (const Vector3d& point : Room{}.points(static_cast<unsigned>(1 + k), 4000)) {
    raw.points.emplace_back(point - kScanPeriod_s * k * velocity);
    raw.doppler.push_back(-raw.points.back().normalized().dot(kAhead) + 0.03 * normal(random));
  }
  return Scan::from_raw(raw);
}

/// A drive whose planes contradict the Doppler; of each scan but the first whether it changed what is known of the
/// error of the sensor.
std::vector<bool> teaches(bool believes) {
  WindowEstimator estimator{WindowConfig{}};
  mapping::PlaneMap map({});
  Scan first_points;
  std::vector<bool> changes;
  for (int k = 0; k < 6; ++k) {
    const Scan whole = hall_seen(k, kAhead);
    const Scan planes = hall_seen(k, kAside);
    const std::vector<double> measured = whole.doppler();
    const std::vector<std::uint8_t> is_moving(whole.size(), 0);
    WindowScan now;
    now.stamp_s = kScanPeriod_s * k;
    now.whole = &whole;
    now.measured = &measured;
    now.is_moving = &is_moving;
    now.static_points = &planes;
    estimator.sort(whole, kOneThread);
    const auto begin = [&] {
      map.clear();
      first_points = planes;
      estimator.begin(now, Eigen::Isometry3d::Identity(), kAhead, {Vector3d::Zero(), WindowConfig{}.start_omega_rad_s},
                      kOneThread);
    };
    if (k == 0) {
      begin();
    } else {
      const Eigen::VectorXd before = estimator.theta();
      bool was_asked = false;
      const WindowMotion motion = estimator.update(
          now, first_points, map, std::nullopt,
          [&](const WindowMotion& found) {
            was_asked = true;
            EXPECT_GT(found.planes.matched, 0.0);
            EXPECT_NEAR(found.T_target_source.translation().x(), -kScanPeriod_s * kAhead.x(), 0.05);
            return believes;
          },
          kOneThread);
      EXPECT_FALSE(motion.diverged);
      EXPECT_TRUE(was_asked);
      changes.push_back(estimator.theta() != before);
      if (!believes) {
        begin();
      }
    }
    WindowScan placed = now;
    placed.stamp_s = estimator.stamp_s();
    estimator.add_to_map(placed, map, kOneThread);
  }
  return changes;
}

TEST(RejectedMotion, TeachesNothingOfTheSensor) {
  EXPECT_EQ(teaches(true), std::vector<bool>(5, true));
  EXPECT_EQ(teaches(false), std::vector<bool>(5, false));
}

}  // namespace
}  // namespace dynamic_icp::window
