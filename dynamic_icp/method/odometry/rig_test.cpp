// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT

#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "testing/dense_algebra.hpp"
#include "testing/synthetic_drive.hpp"
#include "testing/synthetic_rig.hpp"

namespace dynamic_icp::odometry {
namespace {

using namespace synthetic;

RawScan rig_scan(const Drive& drive, const Mountings& mountings, const std::vector<double>& bias_mps, int k) {
  return synthetic::rig_scan(drive.world, drive.path, drive.sensor, mountings, bias_mps, k * drive.period_s,
                             drive.seed);
}

std::vector<Frame> run(const Drive& drive, const Mountings& mountings, const std::vector<double>& bias_mps, int scans) {
  const auto odometry = make_odometry(WindowOdometryConfig{}, {}, 2);
  std::vector<Frame> frames;
  for (int k = 0; k < scans; ++k) {
    frames.push_back(odometry->process(rig_scan(drive, mountings, bias_mps, k)));
  }
  return frames;
}

TEST(WindowOdometryRig, LeverArmsDoNotPullInABend) {
  for (const Sensor& sensor : {Sensor{}, sweeping()}) {
    // 8 m/s and 0.6 rad/s: a sensor 1.5 m ahead of the origin moves sideways by 0.9 m/s, 9 cm a scan.
    const Drive drive{street(), circle(8.0, 0.6), sensor};
    const std::vector<Frame> frames = run(drive, kFrontPair, {}, 12);
    const MotionError error = rms_error(drive, frames, 2);
    EXPECT_LT(error.move_m, 0.004) << sensor.sweep_s;
    EXPECT_LT(error.turn_deg, 0.05) << sensor.sweep_s;
    EXPECT_LT((frames.back().ego.velocity_sensor - velocity_sensor(drive.path, 1.1 + 0.5 * sensor.sweep_s)).norm(),
              0.05);
  }
}

TEST(DynamicIcpRig, LeverArmsDoNotPullInABend) {
  const Drive drive{street(), circle(8.0, 0.6), Sensor{}};
  const auto odometry = make_odometry(PaperConfig{}, {}, 2);
  std::vector<Frame> frames;
  for (int k = 0; k < 8; ++k) {
    frames.push_back(odometry->process(rig_scan(drive, kFrontPair, {}, k)));
    const ego_motion::EgoVelocity& ego = frames.back().ego;
    EXPECT_LT((ego.velocity_sensor - velocity_sensor(drive.path, k * kPeriod_s)).norm(), 0.1) << k;
    EXPECT_NEAR(ego.rotation.value().omega.z(), 0.6, 0.05) << k;
    EXPECT_LT(frames.back().dynamic_candidates, frames.back().points_used / 50) << "nothing moves";
  }
  EXPECT_LT(rms_error(drive, frames, 2).turn_deg, 0.2);
}

TEST(WindowOdometryRig, TheDopplerAloneShowsTheRotationAsWellAsItSays) {
  for (const Sensor& sensor : {Sensor{}, sweeping()}) {
    const Drive drive{street_with_cars(), agile(10.0), sensor};
    const std::vector<Frame> frames = run(drive, kAround, {}, 20);
    double nees = 0.0;
    for (int k = 4; k < 20; ++k) {
      const ego_motion::AngularVelocity& rotation = frames[static_cast<std::size_t>(k)].ego.rotation.value();
      const Vector3d error = rotation.omega - turn_sensor(drive.path, k * kPeriod_s + 0.5 * sensor.sweep_s);
      nees += dense::normalised_squared(error, rotation.covariance) / 16.0;
      EXPECT_LT(error.norm(), 0.05) << k;
    }
    EXPECT_LT(nees, 6.0) << "3 on average where the covariance is right";
    EXPECT_LT(rms_error(drive, frames, 3).move_m, 0.004);
  }
}

TEST(WindowOdometryRig, ScansWithoutMountingsInBetweenAreOfTheSameFrame) {
  const Drive drive{street(), circle(8.0, 0.0), Sensor{}};
  const auto odometry = make_odometry(WindowOdometryConfig{}, {}, 2);
  std::vector<Frame> frames;
  for (int k = 0; k < 8; ++k) {
    RawScan raw = rig_scan(drive, kFrontPair, {}, k);
    if (k >= 4) {
      raw.mountings.clear();  // a driver that forgets them; straight on, lever arms do not show
    }
    frames.push_back(odometry->process(raw));
  }
  EXPECT_LT(rms_error(drive, frames, 2).move_m, 0.004);
}

TEST(WindowOdometryRig, EachSensorMayHaveAnErrorOfItsOwn) {
  const Drive drive{street(), circle(8.0, 0.3), Sensor{}};
  const std::vector<Frame> frames = run(drive, kAround, {0.2, -0.1, 0.05, 0.15}, 16);
  EXPECT_LT(rms_error(drive, frames, 6).move_m, 0.004);
}

}  // namespace
}  // namespace dynamic_icp::odometry
