// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/kiss_icp.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/odometry/frame_steps.hpp"

namespace dynamic_icp::odometry {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kPeriod_s = 0.1;
constexpr std::int64_t kRoomPeriodNs = 100'000'000;

/// A drive along a circle to the left or straight on, from a first speed to a last one. Scan k begins at k * 0.1 s.
struct RoomDrive {
  double start_speed = 0.0;   // m/s
  double acceleration = 1.0;  // m/s^2
  double end_speed = 5.0;     // m/s
  double curvature = 0.0;     // 1/m

  [[nodiscard]] double distance(double t) const {
    const double ramp_s = acceleration > 0.0 ? (end_speed - start_speed) / acceleration : 0.0;
    const double ramp = std::min(t, ramp_s);
    return start_speed * ramp + 0.5 * acceleration * ramp * ramp + end_speed * std::max(0.0, t - ramp_s);
  }

  [[nodiscard]] Isometry3d pose(double t) const {
    Vector6d along;
    along << 0.0, 0.0, curvature * distance(t), distance(t), 0.0, 0.0;
    return exp_se3(along);
  }
};

/// A street along x with ground, house fronts and recesses with cheeks, seen from 1.5 m above ground. Each scan samples
/// other points of it; a sweep measures its points one after the other during the whole period.
RawScan scan_of(const RoomDrive& drive, int k, bool sweeping = false) {
  std::mt19937 random(static_cast<unsigned>(1000 + k));
  const auto uniform = [&] { return static_cast<double>(random()) * 0x1p-32; };
  RawScan raw;
  raw.stamp = Stamp{k * kRoomPeriodNs};
  constexpr int kRounds = 4000;
  const auto add = [&](int round, double x, double y, double z) {
    const double time = sweeping ? kPeriod_s * round / (kRounds - 1) : 0.0;
    raw.points.emplace_back(drive.pose(kPeriod_s * k + time).inverse() * Vector3d(x, y, z));
    raw.doppler.push_back(0.0);
    if (sweeping) {
      raw.times.push_back(time);
    }
  };
  for (int i = 0; i < kRounds; ++i) {
    const double here = drive.distance(kPeriod_s * k) - 40.0;
    const double x = here + 80.0 * uniform();
    const double y = 7.0 * (2.0 * uniform() - 1.0);
    const double z = 5.0 * uniform() - 1.5;
    add(i, x, y, -1.5);
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const bool recess = x - 8.0 * std::floor(x / 8.0) < 3.0;
    add(i, x, side * (recess ? 9.0 : 7.0), z);
    const double cheek = 8.0 * std::floor(x / 8.0) + (i % 4 < 2 ? 0.0 : 3.0);
    add(i, cheek, side * (7.0 + 2.0 * uniform()), z);
  }
  return raw;
}

RawScan empty_room(int k) {
  RawScan raw;
  raw.stamp = Stamp{k * kRoomPeriodNs};
  return raw;
}

double position_error(const Frame& frame, const Isometry3d& T_world_sensor) {
  return (frame.T_world_sensor.translation() - T_world_sensor.translation()).norm();
}

double rotation_error(const Frame& frame, const Isometry3d& T_world_sensor) {
  return rotation_angle(frame.T_world_sensor.linear().transpose() * T_world_sensor.linear());
}

/// Single points 3 m apart, so that none is thinned out and every nearest point is the right one.
std::vector<Vector3d> lattice() {
  std::vector<Vector3d> points;
  for (int x = -3; x <= 3; ++x) {
    for (int y = -3; y <= 3; ++y) {
      for (int z = -1; z <= 1; ++z) {
        const Vector3d point = 3.0 * Vector3d(x, y, z) + Vector3d(0.7, 0.8, 0.9);
        if (point.norm() > 6.0) {
          points.push_back(point);
        }
      }
    }
  }
  return points;
}

RawScan seen_from(const Isometry3d& T_world_sensor, const std::vector<Vector3d>& points, int k) {
  RawScan raw = empty_room(k);
  for (const Vector3d& point : points) {
    raw.points.emplace_back(T_world_sensor.inverse() * point);
  }
  raw.doppler.assign(points.size(), 0.0);
  return raw;
}

TEST(KissIcp, ThinsByTheFirstPointsOfTwoGrids) {
  RawScan raw;
  // Cells of 0.5 m along x: 24, 24, 25, 21, 20, -25; cells of 1.5 m: 8, -, 8, 7, 6, -9.
  raw.points = {{12.3, 0.1, 0.1}, {12.1, 0.1, 0.1}, {12.6, 0.1, 0.1},
                {10.6, 0.1, 0.1}, {10.4, 0.1, 0.1}, {-12.1, 0.1, 0.1}};
  raw.doppler.assign(raw.points.size(), 0.0);
  const ThinnedScan scan = thin(Scan::from_raw(raw), 1.0);
  EXPECT_EQ(scan.map_points.records(), (std::vector<std::uint32_t>{0, 2, 3, 4, 5}));
  EXPECT_EQ(scan.registered.records(), (std::vector<std::uint32_t>{0, 3, 4, 5}));
  const ThinnedScan coarse = thin(Scan::from_raw(raw), 2.0);  // cells of 1 m: 12, 12, 12, 10, 10, -13; of 3 m: 4, 3, -5
  EXPECT_EQ(coarse.map_points.records(), (std::vector<std::uint32_t>{0, 3, 5}));
  EXPECT_EQ(coarse.registered.records(), (std::vector<std::uint32_t>{0, 3, 5}));
}

TEST(KissIcp, RecoversTheExactMotionOfPointsSeenAgain) {
  KissIcp odometry(KissIcpConfig{}, 1);
  EXPECT_EQ(odometry.process(seen_from(Isometry3d::Identity(), lattice(), 0)).points_used, lattice().size());
  const Frame again = odometry.process(seen_from(Isometry3d::Identity(), lattice(), 1));
  EXPECT_EQ(again.status, FrameStatus::kConverged);
  EXPECT_EQ(again.alignment.iterations, 1);
  EXPECT_LT(position_error(again, Isometry3d::Identity()), 1e-12);
  Vector6d step;
  step << 0.004, -0.003, 0.02, 0.2, 0.1, -0.05;
  Isometry3d T_last = Isometry3d::Identity();
  for (int k = 2; k <= 5; ++k) {
    const Isometry3d truth = exp_se3((k - 1.0) * (k - 1.0) * 0.5 * step);  // faster and faster
    const Frame frame = odometry.process(seen_from(truth, lattice(), k));
    EXPECT_EQ(frame.status, FrameStatus::kConverged);
    EXPECT_EQ(frame.alignment.correspondences, lattice().size());
    EXPECT_LT(position_error(frame, truth), 1e-6) << k;
    EXPECT_LT(rotation_error(frame, truth), 1e-7) << k;
    EXPECT_TRUE((T_last * frame.T_target_source.inverse()).isApprox(frame.T_world_sensor, 1e-12));
    EXPECT_TRUE(frame.alignment.covariance);
    T_last = frame.T_world_sensor;
  }
}

TEST(KissIcp, FollowsADriveThatStartsSlowly) {
  const RoomDrive drive{0.0, 2.0, 8.0, 0.0};
  KissIcp odometry(KissIcpConfig{}, 2);
  const Frame first = odometry.process(scan_of(drive, 0));
  EXPECT_EQ(first.status, FrameStatus::kFirst);
  EXPECT_EQ(first.T_world_sensor.matrix(), Isometry3d::Identity().matrix());
  EXPECT_EQ(first.alignment.status, registration::AlignStatus::kNotRun);
  for (int k = 1; k <= 60; ++k) {
    const Frame frame = odometry.process(scan_of(drive, k));
    EXPECT_EQ(frame.status, FrameStatus::kConverged) << k;
    EXPECT_LT(position_error(frame, drive.pose(kPeriod_s * k)), 0.1) << k;
    EXPECT_LT(rotation_error(frame, drive.pose(kPeriod_s * k)), 0.01) << k;
  }
}

TEST(KissIcp, DeskewsTheSweepToItsMiddle) {
  // The first two scans are not deskewed, but the drive begins so slowly that they hardly need to be.
  const RoomDrive drive{0.0, 4.0, 12.0, 0.003};
  const Isometry3d T_first_middle = drive.pose(0.5 * kPeriod_s);
  double mean_error[2] = {0.0, 0.0};
  for (const bool deskew : {false, true}) {
    KissIcpConfig config;
    config.deskew = deskew;
    KissIcp odometry(config, 2);
    for (int k = 0; k <= 60; ++k) {
      const Frame frame = odometry.process(scan_of(drive, k, true));
      const Isometry3d truth = T_first_middle.inverse() * drive.pose(kPeriod_s * (k + 0.5));
      mean_error[deskew ? 1 : 0] += position_error(frame, truth) / 61.0;
    }
  }
  EXPECT_LT(mean_error[1], 0.1);
  EXPECT_GT(mean_error[0], 2.0 * mean_error[1]);
}

TEST(KissIcp, DoesNotStartAtFullSpeed) {
  // 2.7 m from scan to scan, but the prediction is to stand still and the search reaches 1 to 2 m.
  const RoomDrive drive{27.0, 0.0, 27.0, 0.0};
  KissIcp odometry(KissIcpConfig{}, 2);
  Frame frame;
  for (int k = 0; k <= 30; ++k) {
    frame = odometry.process(scan_of(drive, k));
    EXPECT_TRUE(frame.T_world_sensor.matrix().allFinite());
    EXPECT_NE(frame.status, FrameStatus::kNotRun);
  }
  EXPECT_GT(position_error(frame, drive.pose(30 * kPeriod_s)), 20.0);
}

TEST(KissIcp, KeepsThePredictedMotionWhereThereIsNothingToSee) {
  const RoomDrive drive{5.0, 0.0, 5.0, 0.0};
  KissIcp odometry(KissIcpConfig{}, 1);
  EXPECT_EQ(odometry.process(empty_room(0)).status, FrameStatus::kTooFewPoints);
  EXPECT_EQ(odometry.process(scan_of(drive, 1)).status, FrameStatus::kFirst);
  const Isometry3d T_first = drive.pose(kPeriod_s);
  const auto error = [&](const Frame& frame, int k) {
    return position_error(frame, T_first.inverse() * drive.pose(k * kPeriod_s));
  };
  for (int k = 2; k <= 5; ++k) {
    EXPECT_LT(error(odometry.process(scan_of(drive, k)), k), 0.1);
  }
  for (int k = 6; k <= 8; ++k) {
    const Frame lost = odometry.process(empty_room(k));
    EXPECT_EQ(lost.status, FrameStatus::kTooFewPoints);
    EXPECT_EQ(lost.alignment.status, registration::AlignStatus::kNotRun);
    EXPECT_LT(error(lost, k), 0.2);
  }
  RawScan elsewhere = scan_of(drive, 9);
  for (Vector3d& point : elsewhere.points) {
    point.z() += 50.0;
  }
  const Frame lost = odometry.process(elsewhere);
  EXPECT_EQ(lost.status, FrameStatus::kTooFewCorrespondences);
  EXPECT_LT(error(lost, 9), 0.3);
  const Frame found = odometry.process(scan_of(drive, 10));
  EXPECT_TRUE(is_aligned(found.status));
  EXPECT_LT(error(found, 10), 0.15);
}

TEST(KissIcp, LabelsThePointsItRegisters) {
  RawScan raw = seen_from(Isometry3d::Identity(), lattice(), 0);
  raw.points.insert(raw.points.end(), {{NAN, 0, 0}, {4.9, 0, 0}, {100.1, 0, 0}, raw.points[0] + Vector3d(0.01, 0, 0)});
  raw.doppler.resize(raw.points.size(), 0.0);
  const Frame frame = KissIcp(KissIcpConfig{}, 1).process(raw);
  std::vector<std::int32_t> expected(raw.points.size(), 0);
  std::fill(expected.end() - 4, expected.end(), -1);
  EXPECT_EQ(frame.labels, expected);
  EXPECT_EQ(frame.points, raw.points.size());
  EXPECT_EQ(frame.points_used, lattice().size());
  EXPECT_EQ(frame.dropped.out_of_range, 2u);
  EXPECT_EQ(frame.dropped.non_finite, 1u);
}

TEST(KissIcp, RefusesTimeThatStandsStillOrRunsBackwards) {
  const RoomDrive drive{5.0, 0.0, 5.0, 0.0};
  KissIcp odometry(KissIcpConfig{}, 1);
  odometry.process(scan_of(drive, 3));
  EXPECT_THROW(odometry.process(scan_of(drive, 3)), DataError);
  EXPECT_THROW(odometry.process(scan_of(drive, 1)), DataError);
  EXPECT_TRUE(is_aligned(odometry.process(scan_of(drive, 4)).status)) << "the state is unchanged";
}

TEST(KissIcp, SameBitsForAnyNumberOfThreads) {
  const RoomDrive drive{2.0, 2.0, 8.0, 0.003};
  const auto last_pose = [&](int threads) {
    KissIcp odometry(KissIcpConfig{}, threads);
    Frame frame;
    for (int k = 0; k < 8; ++k) {
      frame = odometry.process(scan_of(drive, k, true));
    }
    return frame.T_world_sensor.matrix().eval();
  };
  const Eigen::Matrix4d expected = last_pose(1);
  for (const int threads : {1, 2, 7}) {
    EXPECT_EQ(last_pose(threads), expected) << threads;
  }
}

TEST(KissIcp, RefusesConfigurationsOutOfRange) {
  KissIcpConfig config;
  config.voxel_size_m = 0.0;
  EXPECT_THROW(KissIcp(config, 1), UsageError);
  config = KissIcpConfig{};
  config.min_range_m = config.max_range_m;
  EXPECT_THROW(KissIcp(config, 1), UsageError);
}

TEST(KissIcp, HasTheDefaultsOfReleaseOneTwo) {
  const KissIcpConfig kiss;
  EXPECT_FALSE(kiss.deskew);
  EXPECT_EQ(kiss.min_range_m, 5.0);
  EXPECT_EQ(kiss.max_range_m, 100.0);
  EXPECT_EQ(kiss.voxel_size_m, kiss.max_range_m / 100.0);
  EXPECT_EQ(kiss.max_points_per_voxel, 20);
  EXPECT_EQ(kiss.initial_threshold_m, 2.0);
  EXPECT_EQ(kiss.min_motion_m, 0.1);
  EXPECT_EQ(kiss.max_iterations, 500);
  EXPECT_EQ(kiss.min_step, 1e-4);
}

}  // namespace
}  // namespace dynamic_icp::odometry
