// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/object_tracking.hpp"

#include <numbers>

#include <gtest/gtest.h>

namespace dynamic_icp::evaluation {
namespace {

const ObjectMatching kAtOnce{.warm_up_scans = 0};

/// A car at 10 m/s along x, seen by 100 points.
Body car(std::int64_t id, double x = 20.0) {
  Body body;
  body.id = id;
  body.box.T_sensor_box = Eigen::Translation3d(x, 0.0, 0.0);
  body.box.size << 4.0, 2.0, 1.5;
  body.velocity << 10.0, 0.0, 0.0;
  body.points = 100;
  return body;
}

TEST(ObjectTracking, OfWhatIsReportedAsItIs) {
  const std::vector<ScanBodies> truth = {{0, 0.0, {car(1)}}, {1, 0.1, {car(1, 21.0)}}};
  const std::vector<ScanBodies> reported = {{0, 0.0, {car(5)}}, {1, 0.1, {car(5, 21.0)}}};
  const ObjectTracking tracking = compare_tracks(truth, reported, kAtOnce);
  EXPECT_NEAR(*tracking.score.hota, 1.0, 1e-9);
  EXPECT_NEAR(*tracking.overlap, 1.0, 1e-9);
  EXPECT_EQ(tracking.along_mps, 0.0);
  EXPECT_EQ(tracking.heading_deg, 0.0);
  EXPECT_EQ(tracking.latency_s, 0.0);
  EXPECT_FALSE(tracking.nees_velocity) << "no covariance was stated";
}

TEST(ObjectTracking, MeasuresEachError) {
  Body reported = car(5, 20.3);
  reported.box.T_sensor_box.rotate(Eigen::AngleAxisd(std::numbers::pi / 18.0, Eigen::Vector3d::UnitZ()));
  reported.box.size << 4.3, 2.6, 1.5;
  reported.velocity << 9.0, 2.0, 0.0;
  reported.velocity_covariance = Eigen::Vector3d(0.5, 2.0, 1.0).asDiagonal();
  const ObjectTracking tracking = compare_tracks({{0, 0.0, {car(1)}}}, {{0, 0.0, {reported}}}, kAtOnce);
  EXPECT_NEAR(*tracking.along_mps, 1.0, 1e-12);
  EXPECT_NEAR(*tracking.across_mps, 2.0, 1e-12);
  EXPECT_NEAR(*tracking.heading_deg, 10.0, 1e-9);
  EXPECT_NEAR(*tracking.center_m, 0.3, 1e-12);
  EXPECT_NEAR(*tracking.size_m, 0.3, 1e-12);
  EXPECT_NEAR(*tracking.nees_velocity, 1.0 / 0.5 + 4.0 / 2.0, 1e-12);
}

TEST(ObjectTracking, LeavesOutWhatDoesNotCount) {
  Body slow = car(2, 40.0);
  slow.velocity << 1.0, 0.0, 0.0;
  Body few = car(3, 60.0);
  few.points = 49;
  const std::vector<ScanBodies> truth = {{0, 0.0, {car(1), slow, few}}};
  const ObjectTracking found = compare_tracks(truth, {{0, 0.0, {car(5), car(6, 40.0), car(7, 61.0)}}}, kAtOnce);
  EXPECT_EQ(found.score.true_bodies, 1U);
  EXPECT_EQ(found.score.false_bodies, 0U) << "they are there, though they do not count";
  EXPECT_EQ(compare_tracks(truth, {{0, 0.0, {car(5), car(8, 80.0)}}}, kAtOnce).score.false_bodies, 1U);
  const ObjectTracking early = compare_tracks(truth, {{0, 0.0, {}}});
  EXPECT_EQ(early.scans, 0U) << "the run warms up";
}

TEST(ObjectTracking, LatencyIsFromWhenABodyCounts) {
  std::vector<ScanBodies> truth;
  std::vector<ScanBodies> reported;
  for (int k = 0; k < 5; ++k) {
    Body body = car(1);
    body.points = k == 0 ? 10 : 100;
    truth.push_back({k, 0.1 * k, {body}});
    reported.push_back({k, 0.1 * k, {}});
    if (k >= 3) {
      reported.back().bodies.push_back(car(5));
    }
  }
  EXPECT_NEAR(*compare_tracks(truth, reported, kAtOnce).latency_s, 0.2, 1e-12);
}

}  // namespace
}  // namespace dynamic_icp::evaluation
