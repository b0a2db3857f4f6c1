// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/track_record.hpp"

#include <gtest/gtest.h>

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

/// Of an object that moves with this speed, seen in the scan at 10 s.
TrackRecord record_of(double speed_mps) {
  Detection detection;
  for (int i = 0; i < 40; ++i) {
    detection.points.emplace_back(20.0 + 0.1 * i, 3.0, 0.02 * i);
    detection.directions.push_back(detection.points.back().normalized());
    detection.radial.push_back(speed_mps * detection.directions.back().x());
    detection.times.push_back(0.0);
  }
  TrackRecord record;
  record.track.begin(detection, 10.0, {});
  record.predict(10.0, {}, {});
  record.now.velocity = Vector3d(speed_mps, 0.0, 0.0);
  record.seen = record.age = 1;
  return record;
}

TEST(TrackRecord, TentativeOnesEndWhenTheyAreMissedOrStand) {
  const TrackerConfig config;
  TrackRecord record = record_of(8.0);
  EXPECT_FALSE(record.is_over(10.0, config));
  record.missed = 1;
  EXPECT_TRUE(record.is_over(10.1, config));
  EXPECT_TRUE(record_of(0.5 * config.min_speed_mps).is_over(10.0, config));
}

TEST(TrackRecord, WhatMovedBeforeMayStandForAWhile) {
  const TrackerConfig config;
  TrackRecord record = record_of(8.0);
  record.confirmed = true;
  record.now.centre_covariance = 1e-4 * Eigen::Matrix3d::Identity();
  record.note_motion(10.0, config);
  EXPECT_TRUE(record.has_moved);
  EXPECT_EQ(record.moved_s, 10.0);
  record.now.velocity.setZero();
  record.note_motion(10.1, config);
  EXPECT_EQ(record.moved_s, 10.0) << "it stands";
  EXPECT_FALSE(record.is_over(10.0 + 0.9 * config.stand_s, config));
  EXPECT_TRUE(record.is_over(10.0 + 1.1 * config.stand_s, config));
  record.has_moved = false;
  EXPECT_TRUE(record.is_over(10.1, config)) << "what never moved is no object";
}

TEST(TrackRecord, HiddenOnesLiveAsLongAsTheirPlaceIsKnown) {
  TrackerConfig config;
  config.coast_s = config.stand_s = 100.0;
  TrackRecord record = record_of(8.0);
  record.confirmed = record.has_moved = true;
  record.moved_s = 10.0;
  record.missed = 1;
  record.now.centre_covariance = 100.0 * Eigen::Matrix3d::Identity();
  EXPECT_FALSE(record.is_over(10.1, config)) << "only its length is not known";
  record.predict(14.0, {}, {});
  ASSERT_GT(record.predicted.body().covariance().diagonal().head<2>().sum(),
            2.0 * config.coast_sigma_m * config.coast_sigma_m);
  EXPECT_TRUE(record.is_over(14.0, config));
  record.missed = 0;
  EXPECT_FALSE(record.is_over(14.0, config)) << "it is seen";
}

/// The corner of a body of which as much is seen of one side as of the other.
TEST(TrackRecord, OneThatMayAsWellPointElsewhereIsNotCredibleAtOnce) {
  Detection detection;
  const Vector3d velocity(0.0, -3.0, 0.0);
  for (int i = 0; i < 60; ++i) {
    const double along = 1.5 * (i / 2) / 29.0;
    const Vector3d point =
        Vector3d(40.0, 40.0, 0.05 * (i % 20)) + (i % 2 == 0 ? along * Vector3d::UnitX() : along * Vector3d::UnitY());
    detection.points.push_back(point);
    detection.directions.push_back(point.normalized());
    detection.radial.push_back(velocity.dot(point.normalized()));
    detection.times.push_back(0.0);
  }
  const TrackerConfig config;
  TrackRecord record;
  record.track.begin(detection, 10.0, {});
  record.predict(10.0, {}, {});
  record.now.velocity_covariance.setZero();
  record.seen = 1;
  EXPECT_LT(record.predicted.probability(), 0.6);
  EXPECT_FALSE(record.is_credible({}, config));
  record.seen = config.confirm_anyway_scans;
  EXPECT_TRUE(record.is_credible({}, config));
}

TEST(TrackRecord, WhatTheSensorsOwnErrorExplainsIsNotCredible) {
  const TrackerConfig config;
  TrackRecord record = record_of(1.0);
  record.now.velocity_covariance.setZero();
  EgoError ego;
  EXPECT_TRUE(record.is_credible(ego, config));
  ego.covariance(0, 0) = 0.5 * 0.5;  // along the line of sight: twice as much is within three standard deviations
  EXPECT_FALSE(record.is_credible(ego, config));
}

TEST(TrackRecord, OneOfTwoTakesTheNameOfTheOther) {
  TrackRecord older = record_of(8.0);
  older.id = 3;
  older.age = 12;
  older.seen = 9;
  older.confirmed = true;
  TrackRecord record = record_of(8.0);
  record.id = 7;
  record.has_moved = true;
  record.take_name_of(older);
  EXPECT_EQ(record.id, 3);
  EXPECT_EQ(record.age, 12);
  EXPECT_EQ(record.seen, 9);
  EXPECT_TRUE(record.confirmed);
  EXPECT_TRUE(record.has_moved);
}

}  // namespace
}  // namespace dynamic_icp::tracking
