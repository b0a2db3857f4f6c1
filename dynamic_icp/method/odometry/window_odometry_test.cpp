// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/window_odometry.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "testing/synthetic_drive.hpp"

namespace dynamic_icp::odometry {
namespace {

using namespace synthetic;

/// In the first `divided` scans everything on the left moves by 2 m/s against everything on the right: a column of
/// traffic that fills half of the view, or a wall.
std::vector<Frame> run_divided(int divided, int scans) {
  const Drive drive{street(), circle(8.0, 0.0), {}};
  WindowOdometry odometry({}, {}, 1);
  std::vector<Frame> frames;
  for (int k = 0; k < scans; ++k) {
    RawScan scan = drive.scan(k);
    for (std::size_t i = 0; i < scan.points.size() && k < divided; ++i) {
      const Vector3d u = scan.points[i].normalized();
      scan.doppler[i] += u.y() > 0.0 ? 2.0 * u.x() : 0.0;
    }
    frames.push_back(odometry.process(scan));
  }
  return frames;
}

TEST(WindowOdometry, SaysThatItMayFollowTheTraffic) {
  const std::vector<Frame> frames = run_divided(1, 9);
  EXPECT_EQ(frames[0].ego.status, ego_motion::EgoVelocityStatus::kAmbiguous);
  for (std::size_t k = 1; k <= 4; ++k) {
    EXPECT_EQ(frames[k].status, FrameStatus::kAmbiguous) << k;
    EXPECT_EQ(verdict(frames[k].status), "degenerate");
    ASSERT_TRUE(frames[k].alignment.covariance);
    EXPECT_GT((*frames[k].alignment.covariance)(3, 3), 0.2 * 0.2) << "2 m/s for 0.1 s";
  }
  for (std::size_t k = 5; k < frames.size(); ++k) {
    EXPECT_EQ(frames[k].status, FrameStatus::kConverged) << k;
  }
  for (const Frame& frame : run_divided(0, 4)) {
    EXPECT_EQ(verdict(frame.status), "ok") << "one motion alone";
  }
}

/// A sensor that comes to a queue, and creeps in it.
Path into_a_queue() {
  return [](double t) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = Vector3d(0.9 * t + 14.0 * (1.0 - std::exp(-t)), 0.0, kHeight_m);
    return T;
  };
}

/// Lorries close to both sides and ahead hide all but a hundredth of the street, and are hardly faster than what
/// stands.
World queue() {
  World world = street();
  const Vector3d creeps(0.8, 0.0, 0.0);
  for (const double y : {-4.2, 1.7}) {
    for (const double x : {8.0, 21.0}) {
      world.cars.push_back({{x, y, 0.3}, {x + 9.0, y + 2.5, 3.8}, creeps});
    }
  }
  world.cars.push_back({{21.0, -1.25, 0.3}, {31.0, 1.25, 2.3}, creeps});
  return world;
}

TEST(WindowOdometry, WhatWasSeenToMoveHasNoVoteOnWhatStands) {
  Sensor sensor;
  sensor.doppler_noise_mps = 0.17;
  const Drive drive{queue(), into_a_queue(), sensor};
  const std::vector<Frame> frames = drive.run(WindowOdometryConfig{}, 24);
  for (int k = 1; k < 24; ++k) {
    const Frame& frame = frames[static_cast<std::size_t>(k)];
    EXPECT_LT(error_of(drive, frame, k - 1, k).move_m, 0.03) << k << ": 0.08 with the lorries";
    EXPECT_NE(frame.status, FrameStatus::kLost) << k;
  }
}

// A plain does not show the yaw: its scans are laid down turned, and bend what the next ones find.
TEST(WindowOdometry, ABentMapIsLeftBehind) {
  const Drive on_plain{plain(), circle(8.0, 0.5), sweeping()};
  const Drive in_street{street(), circle(8.0, 0.5), sweeping()};
  WindowOdometry odometry({}, {}, 1);
  for (int k = 0; k < 10; ++k) {
    const Frame frame = odometry.process(k < 2 ? on_plain.scan(k) : in_street.scan(k));
    if (k == 1) {
      EXPECT_EQ(frame.status, FrameStatus::kDegenerate);
    } else if (k >= 8) {
      EXPECT_EQ(verdict(frame.status), "ok") << k;
      EXPECT_LT(error_of(in_street, frame, k - 1, k).turn_deg, 0.02) << k;
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::odometry
