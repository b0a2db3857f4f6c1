// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/compensated_motion.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/method/motion/twist.hpp"
#include "dynamic_icp/method/odometry/dynamic_icp.hpp"
#include "dynamic_icp/method/odometry/scan_to_scan_icp.hpp"

#include "testing/synthetic_drive.hpp"

namespace dynamic_icp::odometry {
namespace {

using namespace synthetic;

/// A scan whose sensor takes its own motion out of the Doppler, by the equations of the path.
RawScan compensated_scan(const Drive& drive, int k) {
  RawScan raw = drive.scan(k);
  for (std::size_t i = 0; i < raw.points.size(); ++i) {
    const double time_s = k * drive.period_s + (raw.times.empty() ? 0.0 : raw.times[i]);
    raw.doppler[i] += raw.points[i].normalized().dot(velocity_sensor(drive.path, time_s));
  }
  raw.doppler_kind = DopplerKind::kCompensated;
  return raw;
}

std::vector<Frame> run(const Drive& drive, Odometry& odometry, int scans) {
  std::vector<Frame> frames;
  for (int k = 0; k < scans; ++k) {
    frames.push_back(odometry.process(compensated_scan(drive, k)));
  }
  return frames;
}

TEST(CompensatedMotion, FollowsALivelyDriveAndItsObjects) {
  for (const Sensor& sensor : {Sensor{}, sweeping()}) {
    const Drive drive{street_with_cars(), agile(10.0), sensor};
    const auto odometry = make_odometry(WindowOdometryConfig{}, {}, 2);
    const std::vector<Frame> frames = run(drive, *odometry, 16);
    const MotionError error = rms_error(drive, frames, 3);
    EXPECT_LT(error.move_m, 0.02) << sensor.sweep_s;
    EXPECT_LT(error.turn_deg, 0.1) << sensor.sweep_s;
    const Frame& last = frames.back();
    EXPECT_EQ(last.ego.status, ego_motion::EgoVelocityStatus::kFromMotion);
    EXPECT_LT((last.ego.velocity_sensor - velocity_sensor(drive.path, 1.5)).norm(), 0.5);
    // The car ahead drives at 12 m/s over ground, whatever the sensor does.
    bool is_found = false;
    for (const tracking::TrackedObject& object : last.tracked) {
      is_found = is_found || std::abs(object.velocity_sensor.norm() - 12.0) < 0.5;
    }
    EXPECT_TRUE(is_found);
  }
}

TEST(CompensatedMotion, ATunnelIsHonestAboutWhatItDoesNotKnow) {
  const Drive drive{tunnel(), circle(12.0, 0.0), {}};
  const auto odometry = make_odometry(WindowOdometryConfig{}, {}, 1);
  const std::vector<Frame> frames = run(drive, *odometry, 6);
  EXPECT_EQ(frames.back().status, FrameStatus::kDegenerate) << "smooth walls hold nothing along the way";
}

TEST(CompensatedMotion, ThePaperFollowsADrive) {
  const Drive drive{street_with_cars(), agile(10.0), {}};
  DynamicIcp odometry(PaperConfig{}, 2);
  const std::vector<Frame> frames = run(drive, odometry, 12);
  const MotionError error = rms_error(drive, frames, 2);
  EXPECT_LT(error.move_m, 0.05);
  EXPECT_LT(error.turn_deg, 0.3);
  EXPECT_EQ(frames.back().alignment.doppler.count, 0u) << "no Doppler term";
  EXPECT_EQ(frames.back().ego.status, ego_motion::EgoVelocityStatus::kFromMotion);
}

TEST(CompensatedMotion, ThePublishedProtocolFollowsADriveFromItsFirstPair) {
  const Drive drive{street_with_cars(), agile(10.0), {}};
  PaperConfig config;
  config.published_compensated = true;
  DynamicIcp odometry(config, 2);
  const std::vector<Frame> frames = run(drive, odometry, 12);
  const MotionError error = rms_error(drive, frames, 1);
  EXPECT_LT(error.move_m, 0.05);
  EXPECT_LT(error.turn_deg, 0.3);
  EXPECT_GT(frames.back().alignment.doppler.count, 0u) << "the authors keep the Doppler term";
}

TEST(CompensatedMotion, DopplerIcpIsLeftWithItsGeometry) {
  const Drive drive{street(), circle(1.0, 0.0), {}};
  SensorContext context;
  context.doppler_kind = DopplerKind::kCompensated;
  ScanToScanIcp odometry(DopplerIcpConfig{}, context, 1);
  EXPECT_EQ(run(drive, odometry, 2).back().alignment.doppler.count, 0u);
  ASSERT_EQ(odometry.assumptions().size(), 2u);
  EXPECT_NE(odometry.assumptions()[1].find("compensated"), std::string::npos);
}

TEST(CompensatedMotion, IsSaid) {
  for (const Config& config : {Config(PaperConfig{}), Config(WindowOdometryConfig{})}) {
    SensorContext context;
    EXPECT_TRUE(make_odometry(config, context, 1)->assumptions().empty());
    context.doppler_kind = DopplerKind::kCompensated;
    EXPECT_EQ(make_odometry(config, context, 1)->assumptions().size(), 1u);
  }
}

}  // namespace
}  // namespace dynamic_icp::odometry
