// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/object_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

#include "testing/boxes_in_view.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;
using Objects = std::vector<TrackedObject>;

/// All objects of each of `scans` scans.
std::vector<Objects> track(const Traffic& traffic, int scans, int threads = 1, const TrackerConfig& config = {}) {
  ObjectTracker tracker{config};
  std::vector<Objects> result;
  for (int k = 0; k < scans; ++k) {
    result.push_back(step(tracker, view_of(traffic(k * kScanPeriod_s), k * kScanPeriod_s), SensorMotion{}, threads));
  }
  return result;
}

void expect_near(const TrackedObject& object, const MovingBox& truth, double along, double across) {
  const Vector3d direction = truth.velocity.normalized();
  const Vector3d error = object.velocity_sensor - truth.velocity;
  EXPECT_LT(std::abs(error.dot(direction)), along) << object.velocity_sensor.transpose();
  EXPECT_LT((error - error.dot(direction) * direction).norm(), across) << object.velocity_sensor.transpose();
  EXPECT_LT((object.centroid - truth.box.centre).head<2>().norm(), 0.8) << object.centroid.transpose();
}

TEST(ObjectTracker, FollowsACarThatDrivesAway) {
  const Traffic traffic = [](double t) { return std::vector<MovingBox>{car(20 + 12 * t, -3, 0.0, 12)}; };
  const std::vector<Objects> scans = track(traffic, 12);
  for (std::size_t k = 5; k < scans.size(); ++k) {
    const Objects objects = confirmed(scans[k]);
    ASSERT_EQ(objects.size(), 1u) << "scan " << k;
    EXPECT_EQ(objects[0].id, 1);
    EXPECT_EQ(objects[0].age_scans, static_cast<int>(k) + 1);
    expect_near(objects[0], traffic(static_cast<double>(k) * kScanPeriod_s)[0], 0.1, 0.5);
    EXPECT_TRUE(objects[0].tangential_observed);
  }
}

TEST(ObjectTracker, MembersAreThePointsOfTheBody) {
  const View view = view_of({car(20, -3, 0.3, 12)}, 0.0, 0.0);
  ObjectTracker tracker{TrackerConfig{}};
  const Objects objects = step(tracker, view);
  ASSERT_EQ(objects.size(), 1u);
  EXPECT_EQ(objects[0].members, rows_on(view, 0));
}

TEST(ObjectTracker, FollowsACarThatTurns) {
  // Radius 15 m at 0.5 rad/s: its Doppler alone would mislead by 0.5 rad/s times the distance, 10 m/s and more.
  const Traffic traffic = [](double t) {
    const double angle = -1.2 + 0.5 * t;
    return std::vector<MovingBox>{
        car(25 + 15 * std::cos(angle), 15 * std::sin(angle), angle + 0.5 * std::numbers::pi, 7.5, 0.5)};
  };
  const std::vector<Objects> scans = track(traffic, 20);
  for (std::size_t k = 8; k < scans.size(); ++k) {
    const Objects objects = confirmed(scans[k]);
    ASSERT_EQ(objects.size(), 1u) << "scan " << k;
    expect_near(objects[0], traffic(static_cast<double>(k) * kScanPeriod_s)[0], 0.8, 0.8);
    EXPECT_NEAR(objects[0].yaw_rate_rps, 0.5, 0.1);
  }
}

TEST(ObjectTracker, KeepsACarThatCrossesTheLineOfSight) {
  // Its radial velocity passes zero at y = 0, where a quarter of its points are not among the moving ones.
  const Traffic traffic = [](double t) {
    return std::vector<MovingBox>{car(15, -8 + 8 * t, 0.5 * std::numbers::pi, 8)};
  };
  const std::vector<Objects> scans = track(traffic, 20);
  for (std::size_t k = 5; k < scans.size(); ++k) {
    const Objects objects = confirmed(scans[k]);
    ASSERT_EQ(objects.size(), 1u) << "scan " << k;
    EXPECT_EQ(objects[0].id, 1);
    expect_near(objects[0], traffic(static_cast<double>(k) * kScanPeriod_s)[0], 0.6, 0.5);
  }
}

TEST(ObjectTracker, TwoCarsThatPassEachOtherKeepTheirIds) {
  const Traffic traffic = [](double t) {
    return std::vector<MovingBox>{car(15 + 10 * t, -2, 0.0, 10), car(35 - 10 * t, 2, std::numbers::pi, 10)};
  };
  const std::vector<Objects> scans = track(traffic, 18);
  const std::int64_t id_away = nearest(confirmed(scans[2]), traffic(0.2)[0].box.centre).id;
  const std::int64_t id_near = nearest(confirmed(scans[2]), traffic(0.2)[1].box.centre).id;
  EXPECT_NE(id_away, id_near);
  for (std::size_t k = 3; k < scans.size(); ++k) {
    const Objects objects = confirmed(scans[k]);
    const std::vector<MovingBox> truth = traffic(static_cast<double>(k) * kScanPeriod_s);
    ASSERT_EQ(objects.size(), 2u) << "scan " << k;
    EXPECT_EQ(nearest(objects, truth[0].box.centre).id, id_away) << "scan " << k;
    EXPECT_EQ(nearest(objects, truth[1].box.centre).id, id_near) << "scan " << k;
  }
}

TEST(ObjectTracker, CarsSideBySideAreTwo) {
  const Traffic traffic = [](double t) {
    return std::vector<MovingBox>{car(20 + 6 * t, -1.75, 0.0, 6), car(20 + 6 * t, 1.75, 0.0, 6)};
  };
  for (const Objects& objects : track(traffic, 8)) {
    EXPECT_EQ(confirmed(objects).size(), 2u);
  }
}

TEST(ObjectTracker, CoastsWhileAnObjectIsHiddenAndKnowsItAgain) {
  // From 0.8 to 1.1 s nothing is seen of it.
  const auto truth = [](double t) { return car(20 + 10 * t, -4, 0.0, 10); };
  const Traffic traffic = [&](double t) {
    return t > 0.75 && t < 1.15 ? std::vector<MovingBox>{} : std::vector<MovingBox>{truth(t)};
  };
  const std::vector<Objects> scans = track(traffic, 16);
  for (std::size_t k = 2; k < scans.size(); ++k) {
    ASSERT_EQ(scans[k].size(), 1u) << "scan " << k;
    EXPECT_EQ(scans[k][0].id, 1);
    const bool hidden = k >= 8 && k <= 11;
    EXPECT_EQ(scans[k][0].status, hidden ? TrackStatus::kCoasting : TrackStatus::kConfirmed) << "scan " << k;
    EXPECT_EQ(scans[k][0].members.empty(), hidden);
    EXPECT_LT((scans[k][0].centroid - truth(static_cast<double>(k) * kScanPeriod_s).box.centre).norm(), 0.8);
  }
  EXPECT_GT(scans[11][0].covariance.trace(), scans[7][0].covariance.trace());
}

TEST(ObjectTracker, AHiddenCarIsNoPartOfTheOneThatFollowsIt) {
  // At 15 m/s the second car comes to where the first was last seen, 7.5 m ahead, while that one is hidden. Of cars
  // seen from behind the length is not known well.
  const Traffic both = [](double t) {
    return std::vector<MovingBox>{car(12 + 15 * t, -4, 0.0, 15), car(19.5 + 15 * t, -4, 0.0, 15)};
  };
  const Traffic traffic = [&](double t) {
    std::vector<MovingBox> boxes = both(t);
    boxes.resize(t > 0.75 && t < 1.15 ? 1 : 2);
    return boxes;
  };
  const std::vector<Objects> scans = track(traffic, 16);
  for (std::size_t k = 3; k < scans.size(); ++k) {
    ASSERT_EQ(scans[k].size(), 2u) << "scan " << k;
    const std::vector<MovingBox> truth = both(static_cast<double>(k) * kScanPeriod_s);
    for (std::size_t i = 0; i < 2; ++i) {
      const TrackedObject& object = nearest(scans[k], truth[i].box.centre);
      EXPECT_EQ(object.id, nearest(scans[3], both(0.3)[i].box.centre).id) << "scan " << k << " car " << i;
      EXPECT_LT((object.centroid - truth[i].box.centre).head<2>().norm(), 2.0) << "scan " << k << " car " << i;
    }
  }
}

TEST(ObjectTracker, ForgetsWhatIsGoneAndNeverUsesItsIdAgain) {
  const Traffic traffic = [](double t) {
    return t > 0.45 && t < 1.25 ? std::vector<MovingBox>{} : std::vector<MovingBox>{car(20, -4, 0.0, 10)};
  };
  TrackerConfig config;
  config.coast_s = 0.5;
  const std::vector<Objects> scans = track(traffic, 15, 1, config);
  EXPECT_EQ(scans[4].size(), 1u);
  EXPECT_EQ(scans[9].size(), 1u) << "the last scan of coasting";
  EXPECT_TRUE(scans[10].empty());
  ASSERT_EQ(scans[14].size(), 1u);
  EXPECT_GT(scans[14][0].id, 1);
}

TEST(ObjectTracker, GrossDopplerErrorsAreNoObjects) {
  ObjectTracker tracker{TrackerConfig{}};
  for (int k = 0; k < 10; ++k) {
    EXPECT_TRUE(confirmed(step(tracker, view_of({}, k * kScanPeriod_s, 0.03))).empty()) << "scan " << k;
  }
}

TEST(ObjectTracker, TellsWhatTheDopplerOfOneScanDoesNot) {
  // At first sight the velocity across the line of sight may be turning; the covariance must allow for that.
  for (const double yaw_rate : {-0.3, 0.0, 0.3}) {
    const Objects objects = track([&](double) { return std::vector<MovingBox>{car(35, 0, 0.0, 10, yaw_rate)}; }, 1)[0];
    ASSERT_EQ(objects.size(), 1u);
    EXPECT_NEAR(objects[0].velocity_sensor.x(), 10.0, 0.2);
    EXPECT_LT(objects[0].covariance(0, 0), objects[0].covariance(1, 1));
    EXPECT_LT(std::abs(objects[0].velocity_sensor.y()), 3.0 * std::sqrt(objects[0].covariance(1, 1)))
        << "yaw rate " << yaw_rate;
    EXPECT_FALSE(objects[0].tangential_observed);
  }
}

TEST(ObjectTracker, TheErrorOfTheSensorsVelocityIsPartOfAllVelocities) {
  // A velocity of the sensor known to 0.6 m/s leaves none over ground known better.
  const Eigen::Matrix3d ego = Vector3d(0.01, 0.36, 0.04).asDiagonal();
  ObjectTracker exact({});
  ObjectTracker unsure({});
  for (int k = 0; k < 8; ++k) {
    const double t = k * kScanPeriod_s;
    const View view = view_of({car(15 + 8 * t, 2, 0.0, 8)}, t, 0.0);
    const SensorMotion rest;
    const auto ground = ground_from(rest.T_world_sensor);
    const auto known = exact.update(view.scan, view.radial, view.is_moving, rest, ground, Workers(1));
    const auto stated = unsure.update(view.scan, view.radial, view.is_moving, rest, ground, Workers(1), ego);
    ASSERT_EQ(known.size(), stated.size());
    for (std::size_t i = 0; i < known.size(); ++i) {
      EXPECT_LT((stated[i].covariance - known[i].covariance - ego).norm(), 1e-12);
      EXPECT_LT((stated[i].prediction.centre_covariance - known[i].prediction.centre_covariance - ego).norm(), 1e-12)
          << "one second ahead";
      EXPECT_FALSE(stated[i].tangential_observed);
    }
  }
}

TEST(ObjectTracker, NothingAndOnePointAreNoObjects) {
  ObjectTracker tracker{TrackerConfig{}};
  EXPECT_TRUE(tracker.update(Scan{}, {}, {}, SensorMotion{}, std::nullopt, Workers(1)).empty());
  RawScan raw;
  raw.stamp = {100000000};
  raw.points = {{10, 0, 0}};
  raw.doppler = {5.0};
  EXPECT_TRUE(tracker
                  .update(Scan::from_raw(raw), std::vector<double>{5.0}, std::vector<std::uint8_t>{1}, SensorMotion{},
                          std::nullopt, Workers(1))
                  .empty());
}

TEST(ObjectTracker, RefusesWhatDoesNotFitTogether) {
  ObjectTracker tracker{TrackerConfig{}};
  const View view = view_of({}, 1.0);
  EXPECT_THROW(tracker.update(view.scan, {}, view.is_moving, SensorMotion{}, std::nullopt, Workers(1)),
               std::invalid_argument);
  step(tracker, view);
  EXPECT_THROW(step(tracker, view), std::invalid_argument) << "the same stamp again";
  TrackerConfig config;
  config.min_points = 0;
  EXPECT_THROW(ObjectTracker{config}, UsageError);
}

TEST(ObjectTracker, NumberOfThreadsChangesNoBit) {
  const Traffic traffic = [](double t) {
    return std::vector<MovingBox>{car(15 + 10 * t, -2, 0.0, 10), car(35 - 10 * t, 2, std::numbers::pi, 10),
                                  car(18, -9 + 8 * t, 0.5 * std::numbers::pi, 8)};
  };
  const std::vector<Objects> one = track(traffic, 8, 1);
  for (const int threads : {2, 4, 7}) {
    const std::vector<Objects> many = track(traffic, 8, threads);
    for (std::size_t k = 0; k < one.size(); ++k) {
      ASSERT_EQ(many[k].size(), one[k].size());
      for (std::size_t i = 0; i < one[k].size(); ++i) {
        EXPECT_EQ(many[k][i].id, one[k][i].id);
        EXPECT_EQ(many[k][i].status, one[k][i].status);
        EXPECT_EQ(many[k][i].velocity_sensor, one[k][i].velocity_sensor);
        EXPECT_EQ(many[k][i].covariance, one[k][i].covariance);
        EXPECT_EQ(many[k][i].yaw_rate_rps, one[k][i].yaw_rate_rps);
        EXPECT_EQ(many[k][i].box.centre, one[k][i].box.centre);
        EXPECT_EQ(many[k][i].box.axes, one[k][i].box.axes);
        EXPECT_EQ(many[k][i].box.size, one[k][i].box.size);
        EXPECT_EQ(many[k][i].centre_covariance, one[k][i].centre_covariance);
        EXPECT_EQ(many[k][i].faces, one[k][i].faces);
        EXPECT_EQ(many[k][i].prediction.centre, one[k][i].prediction.centre);
        EXPECT_EQ(many[k][i].prediction.centre_covariance, one[k][i].prediction.centre_covariance);
        EXPECT_EQ(many[k][i].members, one[k][i].members);
      }
    }
  }
}

TEST(ObjectTracker, WhatIsNearItsSensorBelongsToItsCarrier) {
  TrackerConfig config;
  config.min_range_m = 2.0;
  const ObjectTracker tracker{config};
  RawScan raw;
  raw.points = {{1.9, 0, 0}, {2.1, 0, 0}, {0, -1.2, 1.2}, {0, -1.5, 1.5}, {1.0, 0, 0}, {-30, 0, 0}};
  raw.doppler.assign(raw.points.size(), 0.0);
  std::vector<std::uint8_t> is_moving = {1, 1, 1, 1, 0, 1};
  const Scan scan = Scan::from_raw(raw);
  ScanPatches patches;
  patches.bound(scan, Workers(2));
  tracker.clear_carrier(scan, patches, is_moving);
  EXPECT_EQ(is_moving, (std::vector<std::uint8_t>{0, 1, 0, 1, 0, 1}));
}

TEST(ObjectTracker, InARigTheMountingOfThePointsOwnSensorCounts) {
  RawScan raw;
  raw.mountings.assign(2, Eigen::Isometry3d::Identity());
  raw.mountings[0].translation() = Vector3d(4, 0, 0);
  raw.mountings[1].translation() = Vector3d(-4, 1, 0);
  raw.points = {{4.5, 0, 0}, {4.5, 0, 0}, {-4.2, 1.3, 0}, {-4.2, 1.3, 0}, {0, 0, 0}, {5.5, 0, 0}};
  raw.channels.sensor = {0, 1, 0, 1, 0, 0};
  raw.doppler.assign(raw.points.size(), 0.0);
  std::vector<std::uint8_t> is_moving(raw.points.size(), 1);
  const Scan scan = Scan::from_raw(raw);
  ScanPatches patches;
  patches.bound(scan, Workers(1));
  ObjectTracker{TrackerConfig{}}.clear_carrier(scan, patches, is_moving);
  EXPECT_EQ(is_moving, (std::vector<std::uint8_t>{0, 1, 1, 0, 1, 1})) << "1 m";
}

TEST(ObjectTracker, EverySettingIsInRangeAndFoundByItsKey) {
  TrackerConfig config;
  const ConfigFields all = fields(config);
  EXPECT_NO_THROW(check_fields(all));
  std::set<std::string> keys;
  for (const ConfigField& field : all) {
    EXPECT_TRUE(keys.insert(field.key).second) << field.key;
  }
  EXPECT_TRUE(keys.contains("track.motion.along_mps"));
}

}  // namespace
}  // namespace dynamic_icp::tracking
