// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/detection.hpp"

#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

/// `n` points ahead, measured one after the other over a tenth of a second.
Scan scan_of(std::size_t n) {
  RawScan raw;
  for (std::size_t i = 0; i < n; ++i) {
    raw.points.emplace_back(10.0, 0.01 * static_cast<double>(i), 1.0);
    raw.doppler.push_back(0.0);
    raw.times.push_back(0.1 * static_cast<double>(i) / static_cast<double>(n));
  }
  return Scan::from_raw(raw);
}

SensorMotion left_turn_at(const Vector3d& position) {
  SensorMotion sensor;
  sensor.T_world_sensor.translation() = position;
  sensor.T_world_sensor.linear() = Eigen::AngleAxisd(0.5, Vector3d::UnitZ()).toRotationMatrix();
  sensor.velocity_world = Vector3d(4.0, 0.0, 0.0);
  return sensor;
}

TEST(Detection, IsInTheWorldAndKeepsTheChosenRows) {
  const Scan scan = scan_of(20);
  std::vector<double> radial(20);
  std::iota(radial.begin(), radial.end(), 0.0);
  const std::vector<std::uint32_t> rows = {3, 7, 11};
  const SensorMotion sensor = left_turn_at({100.0, 50.0, 0.0});
  const Ground ground{Eigen::AngleAxisd(0.1, Vector3d::UnitX()).toRotationMatrix(), -1.5};
  Detection detection;
  make_detection(scan, radial, rows, sensor, GroundHeights(ground), nullptr, detection);
  ASSERT_EQ(detection.points.size(), 3u);
  EXPECT_NEAR(detection.mean_time_s, (scan.times()[3] + scan.times()[7] + scan.times()[11]) / 3.0, 1e-15);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_TRUE(detection.points[k].isApprox(sensor.T_world_sensor * scan.points()[rows[k]]));
    EXPECT_TRUE(detection.directions[k].isApprox(sensor.T_world_sensor.linear() * scan.directions()[rows[k]], 1e-12));
    EXPECT_EQ(detection.radial[k], static_cast<double>(rows[k]));
    EXPECT_EQ(detection.times[k], scan.times()[rows[k]]);
  }
  EXPECT_TRUE(detection.sensor.isApprox(Vector3d(100.0 + 4.0 * detection.mean_time_s, 50.0, 0.0)));
  EXPECT_EQ(detection.ground.level, ground.level);
  const Eigen::Isometry3d T_world_sensor = detection.T_sensor_world.inverse();
  EXPECT_TRUE(T_world_sensor.translation().isApprox(detection.sensor, 1e-12)) << "at the mean time";
  const Vector3d u = scan.directions()[7];
  EXPECT_TRUE((T_world_sensor.linear() * u).isApprox(sensor.direction_world(u, detection.mean_time_s), 1e-6));
}

TEST(Detection, LeverArmsOfARigDoNotLookLikeMotion) {
  // A body that turns, seen by two sensors 4 m apart: each point has u . (v + Omega z x (x - p)). Without the lever
  // arms all radial velocities are those of one W = v - Omega z x (p - s).
  const Vector3d velocity(3.0, -7.0, 0.0);
  const Vector3d reference(25.0, 6.0, 0.0);
  const double yaw_rate = 0.6;
  Detection detection;
  for (std::uint64_t i = 0; i < 40; ++i) {
    const RandomSource one = RandomSource(8).fork(i);
    const Vector3d lever(0.0, i % 2 == 0 ? 2.0 : -2.0, 0.5);
    const Vector3d point = reference + Vector3d(one.uniform(0, -2, 2), one.uniform(1, -1, 1), one.uniform(2, -1, 1));
    detection.levers.push_back(lever);
    detection.directions.push_back((point - lever).normalized());
    const Vector3d there = velocity + yaw_rate * Vector3d::UnitZ().cross(point - reference);
    detection.radial.push_back(detection.directions.back().dot(there));
  }
  DetectionMemory memory;
  const auto radial = radial_at_sensor(detection, yaw_rate, memory);
  const Vector3d W = velocity - yaw_rate * Vector3d::UnitZ().cross(reference);
  for (std::size_t i = 0; i < radial.size(); ++i) {
    EXPECT_NEAR(radial[i], detection.directions[i].dot(W), 1e-12);
  }
}

TEST(Detection, ItsMotionIsFittedOnceUnlessARigSeesIt) {
  Detection detection;
  for (std::uint64_t i = 0; i < 40; ++i) {
    const RandomSource one = RandomSource(9).fork(i);
    detection.directions.push_back(Vector3d(10.0, one.uniform(0, -2, 2), one.uniform(1, -1, 1)).normalized());
    detection.radial.push_back(detection.directions.back().dot(Vector3d(4.0, -3.0, 1.0)) + one.uniform(2, -0.1, 0.1));
  }
  const ClusterVelocity anew = motion_of(detection, 0.5, 0.05);
  EXPECT_LT((anew.W - Vector3d(4.0, -3.0, 1.0)).norm(), 0.5);
  fit_motion(0.05, detection);
  ASSERT_TRUE(detection.motion);
  EXPECT_EQ(detection.motion->W, anew.W);
  EXPECT_EQ(detection.motion->information, anew.information);
  EXPECT_EQ(motion_of(detection, -0.5, 0.05).W, anew.W);
  Detection of_rig = detection;
  of_rig.motion.reset();
  of_rig.levers.assign(40, Vector3d(0.0, 1.0, 0.0));
  fit_motion(0.05, of_rig);
  EXPECT_FALSE(of_rig.motion);
  EXPECT_NE(motion_of(of_rig, 0.5, 0.05).W, motion_of(of_rig, -0.5, 0.05).W);
}

TEST(Detection, OfManyRowsAnEvenPartFromEndToEnd) {
  const Scan scan = scan_of(5000);
  std::vector<std::uint32_t> rows(5000);
  std::iota(rows.begin(), rows.end(), 0U);
  Detection detection;
  detection.points.resize(3);  // of another one
  detection.mean_time_s = 0.05;
  make_detection(scan, std::vector<double>(5000, 1.0), rows, SensorMotion{}, GroundHeights(), nullptr, detection);
  EXPECT_LE(detection.points.size(), 500u);
  EXPECT_GE(detection.points.size(), 250u);
  const double step = detection.times[1] - detection.times[0];
  for (std::size_t k = 1; k < detection.times.size(); ++k) {
    EXPECT_NEAR(detection.times[k] - detection.times[k - 1], step, 1e-12);
  }
  EXPECT_LT(scan.times().back() - detection.times.back(), step);
}

}  // namespace
}  // namespace dynamic_icp::tracking
