// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/object_tracking.hpp"

#include <numbers>
#include <tuple>

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
  EXPECT_FALSE(tracking.nees_center);
}

TEST(ObjectTracking, MeasuresEachError) {
  Body reported = car(5, 20.3);
  reported.box.T_sensor_box.rotate(Eigen::AngleAxisd(std::numbers::pi / 18.0, Eigen::Vector3d::UnitZ()));
  reported.box.size << 4.3, 2.6, 1.5;
  reported.velocity << 9.0, 2.0, 0.0;
  reported.velocity_covariance = Eigen::Vector3d(0.5, 2.0, 1.0).asDiagonal();
  reported.center_covariance = Eigen::Vector3d(0.01, 0.02, 0.03).asDiagonal();
  const ObjectTracking tracking = compare_tracks({{0, 0.0, {car(1)}}}, {{0, 0.0, {reported}}}, kAtOnce);
  EXPECT_NEAR(*tracking.along_mps, 1.0, 1e-12);
  EXPECT_NEAR(*tracking.across_mps, 2.0, 1e-12);
  EXPECT_NEAR(*tracking.heading_deg, 10.0, 1e-9);
  EXPECT_NEAR(*tracking.center_m, 0.3, 1e-12);
  EXPECT_NEAR(*tracking.size_m, 0.3, 1e-12);
  EXPECT_NEAR(*tracking.nees_velocity, 1.0 / 0.5 + 4.0 / 2.0, 1e-12);
  EXPECT_NEAR(*tracking.nees_center, 0.09 / 0.01, 1e-12);
}

TEST(ObjectTracking, ACovarianceThatIsNoneHasNoNees) {
  Body reported = car(5);
  reported.center_covariance = Eigen::Vector3d(0.01, -0.02, 0.03).asDiagonal();
  const ObjectTracking tracking = compare_tracks({{0, 0.0, {car(1)}}}, {{0, 0.0, {reported}}}, kAtOnce);
  EXPECT_EQ(tracking.pairs.size(), 1U);
  EXPECT_FALSE(tracking.nees_center);
}

TEST(ObjectTracking, RatesAreByScansAndByTheTimeOfBodies) {
  std::vector<ScanBodies> truth;
  std::vector<ScanBodies> reported;
  for (int k = 0; k < 5; ++k) {  // a scan each 0.2 s; of two bodies one changes its id, one is false in scan 3
    truth.push_back({k, 0.2 * k, {car(1), car(2, 40.0)}});
    reported.push_back({k, 0.2 * k, {car(k < 2 ? 5 : 6), car(7, 40.0)}});
  }
  reported[3].bodies.push_back(car(8, 80.0));
  const ObjectTracking tracking = compare_tracks(truth, reported, kAtOnce);
  EXPECT_NEAR(*tracking.switches_per_100_s, 100.0 / (10 * 0.2), 1e-9);
  EXPECT_NEAR(*tracking.false_per_1000_scans, 200.0, 1e-9);
  const ObjectTracking nothing = compare_tracks({}, {}, kAtOnce);
  EXPECT_FALSE(nothing.switches_per_100_s);
  EXPECT_FALSE(nothing.false_per_1000_scans);
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

TEST(ObjectTracking, LatencyEndsWithAReportOfABodyThatCountedBefore) {
  std::vector<ScanBodies> truth;
  std::vector<ScanBodies> reported;
  for (int k = 0; k < 6; ++k) {  // 100 points in scan 0 and from scan 4 on, reported from scan 1 on
    Body body = car(1);
    body.points = k == 0 || k >= 4 ? 100 : 10;
    truth.push_back({k, 0.1 * k, {body, car(2, 40.0)}});
    reported.push_back({k, 0.1 * k, {car(6, 40.0)}});
    if (k >= 1) {
      reported.back().bodies.push_back(car(5, k < 2 ? 23.0 : 20.0));  // in scan 1 with too little in common
    }
  }
  const ObjectTracking tracking = compare_tracks(truth, reported, kAtOnce);
  EXPECT_NEAR(*tracking.longest_latency_s, 0.2, 1e-12);
  EXPECT_NEAR(*tracking.latency_s, 0.1, 1e-12) << "the other one is reported at once";
}

TEST(ObjectTracking, TheWorstPairsAreOfDifferentBodies) {
  std::vector<BodyPair> pairs;
  for (const auto& [scan, id, overlap] :
       {std::tuple(0, 1, 0.3), {1, 1, 0.2}, {1, 2, 0.25}, {2, 1, 0.2}, {2, 3, 0.9}, {3, 4, 0.5}}) {
    pairs.push_back({scan, 0.1 * scan, car(id), car(7), overlap});
  }
  const std::vector<BodyPair> worst = worst_pairs(pairs, 3);
  ASSERT_EQ(worst.size(), 3U);
  EXPECT_EQ(worst[0].truth.id, 1);
  EXPECT_EQ(worst[0].scan, 1) << "the first of two that are equally bad";
  EXPECT_EQ(worst[1].truth.id, 2);
  EXPECT_EQ(worst[2].truth.id, 4);
  EXPECT_EQ(worst_pairs(pairs, 10).size(), 4U);
}

/// The sensor stands at the origin in scan 0 and, a second later in scan 1, at (5, 0, 0) and turned to the left. The
/// car of body 1 is at (20, 0, 0) in the world first and at (30, 2, 0) then.
struct PredictedCar {
  PredictedCar() {
    Body later = car(1);
    later.box.T_sensor_box = Eigen::Translation3d(2.0, -25.0, 0.0) * Eigen::Quaterniond::Identity();
    later.velocity << 0.0, -10.0, 0.0;  // ahead in the world
    truth = {{0, 100.0, {car(1)}}, {1, 101.0, {later}}};
    poses[0] = Eigen::Isometry3d::Identity();
    poses[1] =
        Eigen::Translation3d(5.0, 0.0, 0.0) * Eigen::AngleAxisd(std::numbers::pi / 2.0, Eigen::Vector3d::UnitZ());
  }

  [[nodiscard]] PredictionError error(const PredictedCenter& predicted, std::int64_t id = 1) const {
    Body reported = car(5);
    reported.prediction = predicted;
    return compare_predictions({{0, 100.0, car(id), reported, 1.0}}, truth, poses);
  }

  std::vector<ScanBodies> truth;
  ScanPoses poses;
};

TEST(ObjectTracking, PredictionsAreComparedInTheAxesTheyWereMadeIn) {
  const PredictedCar scene;
  const Eigen::Matrix3d covariance = Eigen::Vector3d(0.25, 1.0, 1.0).asDiagonal();
  const PredictionError error = scene.error({1.0, {30.5, 2.0, 0.0}, covariance});
  EXPECT_EQ(error.count, 1U);
  EXPECT_NEAR(*error.center_m, 0.5, 1e-9);
  EXPECT_NEAR(*error.nees, 0.25 / 0.25, 1e-9);
  EXPECT_FALSE(scene.error({1.0, {30.5, 2.0, 0.0}, {}}).nees) << "older runs state none";
}

TEST(ObjectTracking, TheTruthIsMovedToTheTimeOfAPrediction) {
  const PredictedCar scene;
  EXPECT_NEAR(*scene.error({1.06, {30.6, 2.0, 0.0}, {}}).center_m, 0.0, 1e-9) << "60 ms at 10 m/s";
}

TEST(ObjectTracking, PredictionsWithoutTruthAreLeftOut) {
  PredictedCar scene;
  EXPECT_EQ(scene.error({2.0, {30.0, 2.0, 0.0}, {}}).count, 0U) << "no scan then";
  EXPECT_EQ(scene.error({1.0, {30.0, 2.0, 0.0}, {}}, 2).count, 0U) << "out of view";
  scene.poses.erase(1);
  EXPECT_EQ(scene.error({1.0, {30.0, 2.0, 0.0}, {}}).count, 0U);
  EXPECT_FALSE(scene.error({1.0, {30.0, 2.0, 0.0}, {}}).center_m);
}

}  // namespace
}  // namespace dynamic_icp::evaluation
