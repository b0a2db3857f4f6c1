// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/sensor_look.hpp"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "testing/synthetic_rig.hpp"

namespace dynamic_icp::diagnosis {
namespace {

using namespace odometry::synthetic;

/// Error of the Doppler by azimuth from the sensor's x axis, m/s.
using ErrorByAzimuth = std::function<double(double azimuth_rad)>;

std::vector<SensorLook> looks_with(const ErrorByAzimuth& error_mps) {
  RawScan raw = rig_scan(street(), circle(8.0, 0.3), Sensor{}, kAround, {0.1, -0.2, 0.0, 0.1}, 1.0);
  for (std::size_t i = 0; i < raw.points.size(); ++i) {
    const Vector3d p = raw.mountings[raw.channels.sensor[i]].inverse() * raw.points[i];
    raw.doppler[i] += error_mps(std::atan2(p.y(), p.x()));
  }
  return look_at_sensors(Scan::from_raw(raw), Workers(1));
}

TEST(SensorLook, EachSensorMovesByItself) {
  const std::vector<SensorLook> looks = looks_with([](double) { return 0.0; });
  ASSERT_EQ(looks.size(), kAround.size());
  for (std::size_t k = 0; k < looks.size(); ++k) {
    ASSERT_TRUE(looks[k].has_velocity()) << k;
    const Vector3d expected = Vector3d(8.0, 0.0, 0.0) + Vector3d(0.0, 0.0, 0.3).cross(kAround[k].translation());
    EXPECT_LT((looks[k].ego.velocity_sensor - expected).norm(), 0.15) << k;
    EXPECT_LT((looks[k].ego.velocity_sensor - expected).head<2>().norm(), 0.04) << k;
    EXPECT_LT(looks[k].direction_error_mps, 0.01) << "noise is no error by direction";
  }
}

TEST(SensorLook, AnErrorByDirectionIsMeasured) {
  // Over 120 degrees, four periods of 30 degrees: neither a velocity nor a bias explains any of it.
  const std::vector<SensorLook> looks = looks_with([](double azimuth) { return 0.15 * std::sin(12.0 * azimuth); });
  for (const SensorLook& look : looks) {
    EXPECT_NEAR(look.direction_error_mps, 0.15 / std::sqrt(2.0), 0.03);
  }
}

// What a velocity hides of an error shows in what it leaves: half of this error looks like a velocity to the left.
TEST(SensorLook, WhatIsPretendedIsAllowedFor) {
  const std::vector<SensorLook> looks =
      looks_with([](double azimuth) { return 0.15 * (std::sin(azimuth) + std::sin(4.0 * azimuth)); });
  const Vector3d expected = Vector3d(8.0, 0.0, 0.0) + Vector3d(0.0, 0.0, 0.3).cross(kAround[0].translation());
  const double pretended = std::abs(looks[0].ego.velocity_sensor.y() - expected.y());
  EXPECT_GT(pretended, 0.1) << "the error does harm";
  EXPECT_LT(pretended, 3.0 * std::sqrt(looks[0].pretended(1, 1)));
}

TEST(SensorLook, ANarrowViewPretendsMore) {
  Sensor narrow;
  narrow.width_rad = 0.6;
  const Mountings ahead = {mounted_at(1.5, 0.0, 0.0), mounted_at(1.5, 0.5, 0.0)};
  const RawScan raw = rig_scan(street(), circle(8.0, 0.0), narrow, ahead, {}, 1.0);
  const std::vector<SensorLook> narrow_looks = look_at_sensors(Scan::from_raw(raw), Workers(1));
  const std::vector<SensorLook> wide_looks = looks_with([](double) { return 0.0; });
  EXPECT_GT(narrow_looks[0].pretended(1, 1), 2.0 * wide_looks[0].pretended(1, 1));
}

}  // namespace
}  // namespace dynamic_icp::diagnosis
