// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "testing/synthetic_drive.hpp"

namespace dynamic_icp::odometry {
namespace {

using namespace synthetic;

/// The motion of the second scan, from five speeds, straight and turning.
void expect_starts(const Sensor& sensor, double max_m, double max_deg) {
  for (const double rotation : {0.0, 0.6}) {
    for (const double speed : {0.0, 5.0, 15.0, 27.0, 40.0}) {
      SCOPED_TRACE(std::to_string(speed) + " m/s, " + std::to_string(rotation) + " rad/s");
      const Drive drive{street(), circle(speed, rotation), sensor};
      const std::vector<Frame> frames = drive.run(WindowOdometryConfig{}, 2);
      EXPECT_EQ(frames[0].status, FrameStatus::kFirst);
      EXPECT_TRUE(frames[0].T_world_sensor.isApprox(Eigen::Isometry3d::Identity()));
      EXPECT_EQ(verdict(frames[1].status), "ok");
      const MotionError error = error_of(drive, frames[1], 0, 1);
      EXPECT_LT(error.move_m, max_m);
      EXPECT_LT(error.turn_deg, max_deg);
      EXPECT_LT((frames[0].ego.velocity_sensor - Vector3d(speed, 0.0, 0.0)).norm(), 0.05) << "already the first scan";
    }
  }
}

TEST(WindowOdometryDrive, StartsAtAnySpeedAndTurn) { expect_starts(Sensor{}, 0.003, 0.03); }

// The first scan of a sweep has to be deskewed by what the second shows: the first pair is known less well.
TEST(WindowOdometryDrive, StartsAtAnySpeedAndTurnInASweep) { expect_starts(sweeping(), 0.015, 0.08); }

TEST(WindowOdometryDrive, FollowsALivelyDrive) {
  const Drive drive{street_with_cars(), agile(10.0), {}};
  const std::vector<Frame> frames = drive.run(WindowOdometryConfig{}, 20);
  const MotionError error = rms_error(drive, frames);
  EXPECT_LT(error.move_m, 0.001);
  EXPECT_LT(error.turn_deg, 0.007);
  const Eigen::Isometry3d T_world_last = drive.path(0.0).inverse() * drive.path(1.9);
  EXPECT_LT((frames.back().T_world_sensor.translation() - T_world_last.translation()).norm(), 0.02);
  for (std::size_t k = 1; k < frames.size(); ++k) {
    EXPECT_EQ(verdict(frames[k].status), "ok");
    EXPECT_LT(twist_error(drive, frames[k], static_cast<int>(k)).tail<3>().norm(), 0.03) << k;
  }
}

// What is known of the past stays within what numbers hold.
TEST(WindowOdometryDrive, GoesOnForLong) {
  const Drive drive{street(), agile(20.0), {}};
  const std::vector<Frame> frames = drive.run(WindowOdometryConfig{}, 100);
  for (std::size_t k = 1; k < frames.size(); ++k) {
    EXPECT_EQ(frames[k].status, FrameStatus::kConverged) << k;
    EXPECT_LT(error_of(drive, frames[k], static_cast<int>(k) - 1, static_cast<int>(k)).move_m, 0.005) << k;
  }
}

// The same sweeps with the times of their points, with declared times, as if taken in an instant, and not deskewed.
TEST(WindowOdometryDrive, UndoesSweeps) {
  Drive drive{street_with_cars(), agile(10.0), sweeping()};
  const MotionError timed = rms_error(drive, drive.run(WindowOdometryConfig{}, 14), 4);
  const MotionError not_deskewed = rms_error(drive, drive.run(with_ablation("no-deskew"), 14), 4);
  drive.sensor.gives_times = false;
  WindowOdometryConfig declared;
  declared.sweep.declared_duration_s = 0.1;
  const MotionError as_declared = rms_error(drive, drive.run(declared, 14), 4);
  const MotionError untimed = rms_error(drive, drive.run(WindowOdometryConfig{}, 14), 4);
  EXPECT_LT(timed.move_m, 0.0015);
  EXPECT_LT(timed.turn_deg, 0.02);
  EXPECT_LT(as_declared.move_m, 1.5 * timed.move_m);
  EXPECT_LT(as_declared.turn_deg, 1.5 * timed.turn_deg);
  EXPECT_GT(untimed.move_m, 3.0 * timed.move_m);
  EXPECT_EQ(untimed.move_m, not_deskewed.move_m) << "times that are not used must not matter";
}

TEST(WindowOdometryDrive, KnowsTheWayInATunnelFromTheDoppler) {
  for (const Sensor& sensor : {Sensor{}, sweeping()}) {
    const Drive drive{tunnel(), agile(10.0), sensor};
    const std::vector<Frame> frames = drive.run(WindowOdometryConfig{}, 12);
    EXPECT_LT(rms_error(drive, frames, 4).move_m, 0.0015);
    EXPECT_EQ(frames.back().status, FrameStatus::kConverged);
    EXPECT_LT((frames.back().T_world_sensor.translation() - (drive.path(0.0).inverse() * drive.path(1.1)).translation())
                  .norm(),
              0.05);
  }
}

TEST(WindowOdometryDrive, SaysWhatATunnelHidesWithoutTheDoppler) {
  const Drive drive{tunnel(), circle(10.0, 0.0), {}};
  const std::vector<Frame> frames = drive.run(with_ablation("no-dr"), 6);
  const std::vector<Frame> with_doppler = drive.run(WindowOdometryConfig{}, 6);
  double slid_m = 0.0;
  double slid_with_doppler_m = 0.0;
  for (std::size_t k = 1; k < frames.size(); ++k) {
    ASSERT_EQ(frames[k].status, FrameStatus::kDegenerate) << k;
    EXPECT_GT(std::abs(frames[k].alignment.degenerate.front().direction[3]), 0.99) << "along the tunnel";
    const int scan = static_cast<int>(k);
    slid_m = std::max(slid_m, error_of(drive, frames[k], scan - 1, scan).move_m);
    slid_with_doppler_m = std::max(slid_with_doppler_m, error_of(drive, with_doppler[k], scan - 1, scan).move_m);
  }
  EXPECT_GT(slid_m, 2.0 * slid_with_doppler_m) << "the Doppler was left out";
}

TEST(WindowOdometryDrive, SaysThatAPlainDoesNotShowTheYaw) {
  const Drive drive{plain(), circle(10.0, 0.1), {}};
  const std::vector<Frame> frames = drive.run(WindowOdometryConfig{}, 8);
  for (int k = 1; k < 8; ++k) {
    const Frame& frame = frames[static_cast<std::size_t>(k)];
    ASSERT_EQ(frame.status, FrameStatus::kDegenerate) << k;
    EXPECT_EQ(verdict(frame.status), "degenerate");
    ASSERT_EQ(frame.alignment.degenerate.size(), 1u) << "all but the yaw is known";
    EXPECT_GT(std::abs(frame.alignment.degenerate[0].direction[2]), 0.99);
    const MotionError error = error_of(drive, frame, k - 1, k);
    EXPECT_LT(error.left.head<2>().norm(), 0.001) << "roll and pitch";
    EXPECT_LT(std::abs(error.left[2]), 7.0 * std::sqrt((*frame.alignment.covariance)(2, 2)));
    EXPECT_LT(nis(error.left, *frame.alignment.covariance), 50.0) << "way and yaw err together";
    EXPECT_NEAR(frame.T_target_source.translation().norm(), 1.0, 0.005) << "the length of the way";
  }
}

TEST(WindowOdometryDrive, FindsAConstantErrorOfTheDoppler) {
  Drive drive{street_with_cars(), agile(10.0), {}};
  drive.sensor.bias_mps = 0.2;
  const std::vector<Frame> frames = drive.run(WindowOdometryConfig{}, 8);
  EXPECT_NEAR(frames.back().ego.bias_mps, 0.2, 0.03);
  EXPECT_LT(rms_error(drive, frames, 3).move_m, 0.002);
  EXPECT_LT(twist_error(drive, frames.back(), 7).tail<3>().norm(), 0.03);
  const std::vector<Frame> without = drive.run(with_ablation("no-bias"), 4);
  EXPECT_EQ(without.back().ego.bias_mps, 0.0);
  EXPECT_GT(twist_error(drive, without.back(), 3).tail<3>().norm(), 0.1);
}

TEST(WindowOdometryDrive, FollowsTheCars) {
  for (const Sensor& sensor : {Sensor{}, sweeping()}) {
    const Drive drive{street_with_cars(), agile(10.0), sensor};
    const auto odometry = make_odometry(WindowOdometryConfig{}, {}, 1);
    std::vector<std::int64_t> ids(2, 0);
    for (int k = 0; k < 10; ++k) {
      const TrueScan truth = scan_at(drive.world, drive.path, drive.sensor, k * kPeriod_s);
      const Frame frame = odometry->process(truth.raw);
      const Eigen::Matrix3d R_sensor_world = drive.path(k * kPeriod_s).linear().transpose();
      for (const tracking::TrackedObject& object : frame.tracked) {
        std::vector<int> counts(3, 0);  // of the points with its label: on what stands, on the first and second car
        for (std::size_t i = 0; i < frame.labels.size(); ++i) {
          counts[static_cast<std::size_t>(truth.car[i] + 1)] += frame.labels[i] == object.id ? 1 : 0;
        }
        const std::size_t car = counts[1] > counts[2] ? 0 : 1;
        ASSERT_GT(counts[car + 1], 10) << "an object where no car is";
        EXPECT_EQ(counts[2 - car], 0) << "points of the other car";
        EXPECT_LE(counts[0], counts[car + 1] / 10);
        EXPECT_TRUE(ids[car] == 0 || ids[car] == object.id) << "the name of car " << car << " changed in scan " << k;
        ids[car] = object.id;
        const Vector3d error = object.velocity_sensor - R_sensor_world * drive.world.cars[car].velocity;
        EXPECT_LT(std::abs((R_sensor_world.transpose() * error).x()), k < 5 ? 0.5 : 0.3) << "along its way, scan " << k;
      }
      const auto is_on_object = [](std::int32_t label) { return label > 0; };
      if (k >= 3) {
        EXPECT_EQ(frame.tracked.size(), 2u) << k;
        EXPECT_GT(2 * std::count_if(frame.labels.begin(), frame.labels.end(), is_on_object),
                  std::count_if(truth.car.begin(), truth.car.end(), [](int car) { return car >= 0; }));
      }
    }
  }
}

// Six unknowns: a mean of six where the covariance is right. Bounds leave room for what it must be cautious of.
TEST(WindowOdometryDrive, StatesHowWellTheMotionIsKnown) {
  for (const Sensor& sensor : {Sensor{}, sweeping()}) {
    double motion = 0.0;
    double twist = 0.0;
    int count = 0;
    for (const std::uint64_t seed : {1UL, 2UL}) {
      for (const World& world : {street(), tunnel()}) {
        const Drive drive{world, agile(seed == 1 ? 8.0 : 14.0), sensor, kPeriod_s, seed};
        const std::vector<Frame> frames = drive.run(WindowOdometryConfig{}, 11);
        for (int k = 1; k < 11; ++k) {
          const Frame& frame = frames[static_cast<std::size_t>(k)];
          motion += nis(error_of(drive, frame, k - 1, k).left, *frame.alignment.covariance);
          twist += nis(twist_error(drive, frame, k), frame.twist->covariance);
          ++count;
        }
      }
    }
    this->RecordProperty("motion", std::to_string(motion / count));
    EXPECT_LT(motion / count, 12.0);
    EXPECT_GT(motion / count, 0.4);
    EXPECT_LT(twist / count, 12.0);
    EXPECT_GT(twist / count, 0.5);
  }
}

TEST(WindowOdometryDrive, SameBitsForAnyNumberOfThreads) {
  const Drive drive{street_with_cars(), agile(10.0), sweeping()};
  const std::vector<Frame> one = drive.run(WindowOdometryConfig{}, 5, 1);
  const std::vector<Frame> three = drive.run(WindowOdometryConfig{}, 5, 3);
  EXPECT_FALSE(one.back().tracked.empty());
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_TRUE(same_bits(one[k], three[k])) << k;
  }
}

TEST(WindowOdometryDrive, EveryAblationRuns) {
  const Drive drive{street_with_cars(), agile(10.0), sweeping()};
  for (const std::string_view name : ablation_names(WindowOdometryConfig{})) {
    const std::vector<Frame> frames = drive.run(with_ablation(name), 3);
    EXPECT_TRUE(frames.back().T_world_sensor.matrix().allFinite()) << name;
    EXPECT_TRUE(verdict(frames.back().status) != "lost" || name == "no-planes") << name;
    EXPECT_EQ(frames.back().tracked.empty(), name == "no-vf" || name == "no-dpp") << name;
    EXPECT_EQ(frames.back().dynamic_candidates == 0, name == "no-vf") << name;
  }
}

TEST(WindowOdometryDrive, WithoutAMapOnlyTheLastScanCounts) {
  const Drive drive{street(), agile(10.0), {}};
  const WindowOdometryConfig config = with_ablation("no-map");
  const MotionError error = rms_error(drive, drive.run(config, 12), 3);
  EXPECT_GT(error.turn_deg, 1.05 * rms_error(drive, drive.run(WindowOdometryConfig{}, 12), 3).turn_deg);
}

TEST(WindowOdometryDrive, SearchesForTheFirstTurn) {
  Drive drive{street(), circle(4.0, 0.6), {}};
  drive.period_s = 0.5;
  EXPECT_LT(error_of(drive, drive.run(WindowOdometryConfig{}, 2).back(), 0, 1).turn_deg, 0.05);
  EXPECT_GT(error_of(drive, drive.run(with_ablation("no-search"), 2).back(), 0, 1).turn_deg, 1.0);
}

// Where most of what is seen creeps, the median velocity is that of dynamic outliers.
TEST(WindowOdometryDrive, ConsensusFindsTheStaticSceneInACrowd) {
  Drive drive{street(), circle(4.0, 0.0), {}};
  for (int k = 0; k < 6; ++k) {
    for (const double y : {3.0, -5.0}) {
      drive.world.cars.push_back({{4.0 + 7.0 * k, y, 0.1}, {8.5 + 7.0 * k, y + 2.0, 1.7}, {1.5, 0.0, 0.0}});
    }
  }
  const Frame frame = drive.run(WindowOdometryConfig{}, 2).back();
  EXPECT_LT(std::abs(frame.ego.velocity_sensor.x() - 4.0), 0.05);
}

}  // namespace
}  // namespace dynamic_icp::odometry
