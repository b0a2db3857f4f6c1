// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/tracking/object_tracker.hpp"

#include "testing/boxes_in_view.hpp"
#include "testing/dense_algebra.hpp"

namespace dynamic_icp::tracking {
namespace {

// What road users do: stop and drive on, hide, drive side by side, turn.

using Eigen::Vector3d;
using Objects = std::vector<TrackedObject>;

constexpr double kQuarter = 0.5 * std::numbers::pi;

/// Stands between azimuths `from` and `to` (degrees) at a range, higher than all else.
MovingBox pillar(double from, double to, double range) {
  const double low = range * std::tan(from * std::numbers::pi / 180.0);
  const double high = range * std::tan(to * std::numbers::pi / 180.0);
  return {
      {{range, 0.5 * (low + high), 0.0}, Eigen::Matrix3d::Identity(), {0.1, high - low, 4.0}}, Vector3d::Zero(), 0.0};
}

/// A way with a stop: 8 m/s, braking down to zero, 3 s of rest, 2 m/s^2 up again.
struct Way {
  double metres = 0.0;
  double speed = 0.0;
};
Way stop_and_go(double t, double braking_mps2) {
  constexpr double kBegin_s = 1.0;
  const double stop_s = kBegin_s + 8.0 / braking_mps2;
  const double go_s = stop_s + 3.0;
  if (t < kBegin_s) {
    return {8.0 * t, 8.0};
  }
  if (t < stop_s) {
    const double s = t - kBegin_s;
    return {8.0 + 8.0 * s - 0.5 * braking_mps2 * s * s, 8.0 - braking_mps2 * s};
  }
  const double s = std::max(0.0, t - go_s);
  return {8.0 + 32.0 / braking_mps2 + s * s, 2.0 * s};
}

/// Follows a car that drives such a way from `start`, for 2 s after it drives on.
void expect_one_through_a_stop(const Vector3d& start, double yaw, double braking_mps2) {
  const Traffic traffic = [&](double t) {
    const Way way = stop_and_go(t, braking_mps2);
    const Vector3d place = start + way.metres * upright_axes(yaw).col(0);
    return std::vector<MovingBox>{car(place.x(), place.y(), yaw, way.speed)};
  };
  ObjectTracker tracker{TrackerConfig{}};
  const int scans = static_cast<int>((1.0 + 8.0 / braking_mps2 + 3.0 + 2.0) / kScanPeriod_s);
  for (int k = 0; k < scans; ++k) {
    const double t = k * kScanPeriod_s;
    const Objects objects = step(tracker, view_of(traffic(t), t));
    if (k < 5) {
      continue;
    }
    ASSERT_EQ(objects.size(), 1u) << "scan " << k << " yaw " << yaw;
    EXPECT_EQ(objects[0].id, 1) << "scan " << k << " yaw " << yaw;
    EXPECT_NE(objects[0].status, TrackStatus::kTentative);
    const MovingBox truth = traffic(t)[0];
    EXPECT_LT((objects[0].velocity_sensor - truth.velocity).norm(), 0.8) << "scan " << k << " yaw " << yaw;
    // Seen from behind it has a length that is likely.
    EXPECT_LT((objects[0].centroid - truth.box.centre).head<2>().norm(), 0.8) << "scan " << k << " yaw " << yaw;
  }
}

TEST(ObjectTrackerTraffic, ACarThatStopsAtALightAndDrivesOnKeepsItsId) {
  expect_one_through_a_stop({12, -3, 0}, 0.0, 1.6);
  expect_one_through_a_stop({50, 3, 0}, std::numbers::pi, 1.6);
  expect_one_through_a_stop({22, -15, 0}, kQuarter, 1.6);
}

TEST(ObjectTrackerTraffic, ACarThatBrakesHardAtALightKeepsItsId) {
  expect_one_through_a_stop({12, -3, 0}, 0.0, 4.0);
  expect_one_through_a_stop({40, 3, 0}, std::numbers::pi, 4.0);
  expect_one_through_a_stop({20, -10, 0}, kQuarter, 4.0);
}

TEST(ObjectTrackerTraffic, WhatNeverMovedIsNone) {
  ObjectTracker tracker{TrackerConfig{}};
  for (int k = 0; k < 10; ++k) {
    EXPECT_TRUE(confirmed(step(tracker, view_of({car(15, -3, 0.0, 0.0)}, k * kScanPeriod_s))).empty()) << "scan " << k;
  }
}

/// A car that crosses behind a pillar, which hides it for a second.
std::vector<MovingBox> behind_a_pillar(double t) {
  return {car(22, -13 + 9 * t, kQuarter, 9), pillar(-14.0, 15.0, 10.0)};
}

TEST(ObjectTrackerTraffic, ACarHiddenForASecondKeepsItsId) {
  ObjectTracker tracker{TrackerConfig{}};
  int hidden = 0;
  for (int k = 0; k < 29; ++k) {
    const double t = k * kScanPeriod_s;
    const View view = view_of(behind_a_pillar(t), t);
    const Objects objects = step(tracker, view);
    const MovingBox truth = behind_a_pillar(t)[0];
    if (k < 5) {
      continue;
    }
    ASSERT_EQ(objects.size(), 1u) << "scan " << k;
    EXPECT_EQ(objects[0].id, 1) << "scan " << k;
    if (rows_on(view, 0).empty()) {
      ++hidden;
      EXPECT_EQ(objects[0].status, TrackStatus::kCoasting) << "scan " << k;
      EXPECT_LT((objects[0].centroid - truth.box.centre).head<2>().norm(), 0.8) << "scan " << k;
    }
    const Vector3d error = objects[0].velocity_sensor - truth.velocity;
    EXPECT_LT(error.dot(objects[0].covariance.inverse() * error), 25.0) << "scan " << k;
    if (k > 25) {
      EXPECT_LT(error.norm(), 1.0) << "scan " << k;
      EXPECT_LT((objects[0].centroid - truth.box.centre).head<2>().norm(), 0.3) << "scan " << k;
    }
  }
  EXPECT_GE(hidden, 8);
}

TEST(ObjectTrackerTraffic, TheSideThatIsSeenOfACarBehindAPillarIsNotTheFarOne) {
  // Of its other sides nothing is seen while one end of it is hidden: its width is what it was.
  ObjectTracker tracker{TrackerConfig{}};
  for (int k = 0; k < 29; ++k) {
    const double t = k * kScanPeriod_s;
    const View view = view_of(behind_a_pillar(t), t);
    const Objects objects = step(tracker, view);
    if (k < 5 || rows_on(view, 0).empty()) {
      continue;
    }
    ASSERT_EQ(objects.size(), 1u) << "scan " << k;
    const Vector3d error = objects[0].centroid - behind_a_pillar(t)[0].box.centre;
    EXPECT_LT(std::abs(error.x()), 0.3) << "scan " << k;
    EXPECT_NEAR(objects[0].box.size.y(), 1.8, 0.6) << "scan " << k;
  }
}

TEST(ObjectTrackerTraffic, TwoSidesOfOneCarSeenApartBecomeOne) {
  // A pillar hides its corner at first: its rear on one side of it, and more than half of its side on the other.
  const Traffic traffic = [](double t) {
    const double yaw = 0.7;
    const Vector3d place = Vector3d(17, 0, 0) + 7.0 * t * upright_axes(yaw).col(0);
    const OrientedBox box = car(place.x(), place.y(), yaw, 7.0).box;
    const Vector3d corner = box.centre + box.axes * Vector3d(-2.2, -0.9, 0.0);
    const double azimuth = std::atan2(corner.y(), corner.x()) * 180.0 / std::numbers::pi;
    std::vector<MovingBox> boxes{car(place.x(), place.y(), yaw, 7.0)};
    if (t < 1.0) {
      boxes.push_back(pillar(azimuth - 1.8, azimuth + 1.8, 6.0));
    }
    return boxes;
  };
  ObjectTracker tracker{TrackerConfig{}};
  for (int k = 0; k < 20; ++k) {
    const double t = k * kScanPeriod_s;
    const View view = view_of(traffic(t), t);
    const Objects objects = confirmed(step(tracker, view));
    if (k < 3) {
      continue;
    }
    ASSERT_EQ(objects.size(), 1u) << "scan " << k;
    const MovingBox truth = traffic(t)[0];
    EXPECT_LT((objects[0].velocity_sensor - truth.velocity).norm(), 1.0) << "scan " << k;
    EXPECT_LT((objects[0].centroid - truth.box.centre).head<2>().norm(), 0.8) << "scan " << k;
    EXPECT_GT(objects[0].members.size(), rows_on(view, 0).size() * 4 / 5) << "scan " << k;
  }
}

/// Two in lanes beside each other, `apart` from each other and `middle` (m) to the left of the sensor.
Traffic abreast(double x, double middle, double apart, double speed) {
  return [=](double t) {
    return std::vector<MovingBox>{car(x + speed * t, middle - 0.5 * apart, 0.0, speed),
                                  car(x + speed * t, middle + 0.5 * apart, 0.0, speed)};
  };
}

void expect_two(const Traffic& traffic, int scans) {
  ObjectTracker tracker{TrackerConfig{}};
  std::int64_t right = 0;
  std::int64_t left = 0;
  for (int k = 0; k < scans; ++k) {
    const double t = k * kScanPeriod_s;
    const Objects objects = confirmed(step(tracker, view_of(traffic(t), t)));
    if (k < 4) {
      continue;
    }
    ASSERT_EQ(objects.size(), 2u) << "scan " << k;
    const std::vector<MovingBox> truth = traffic(t);
    const TrackedObject& first = nearest(objects, truth[0].box.centre);
    const TrackedObject& second = nearest(objects, truth[1].box.centre);
    right = k == 4 ? first.id : right;
    left = k == 4 ? second.id : left;
    EXPECT_NE(first.id, second.id);
    EXPECT_EQ(first.id, right) << "scan " << k;
    EXPECT_EQ(second.id, left) << "scan " << k;
    for (const TrackedObject* object : {&first, &second}) {
      EXPECT_LT(object->box.size.y(), 2.2) << "scan " << k;
      EXPECT_LT((object->velocity_sensor - truth[0].velocity).norm(), 0.5) << "scan " << k;
    }
  }
}

TEST(ObjectTrackerTraffic, CarsAbreastWithOneVelocityStayTwo) {
  expect_two(abreast(15, 0.0, 3.2, 12), 20);
  expect_two(abreast(25, 0.0, 3.0, 8), 20);
}

TEST(ObjectTrackerTraffic, CarsAbreastInAJamStayTwo) { expect_two(abreast(20, 0.0, 2.9, 0.8), 40); }

TEST(ObjectTrackerTraffic, CarsAbreastOnTheNextLanesStayTwo) {
  expect_two(abreast(18, 4.0, 3.0, 8), 20);
  expect_two(abreast(12, 4.0, 2.9, 1.2), 40);
}

TEST(ObjectTrackerTraffic, ColumnsOfPointsOnTheFlanksOfCarsAbreastAreNoObjects) {
  // So near and straight ahead rays meet the sides that look at each other more than a metre apart.
  expect_two(abreast(12, 0.0, 2.9, 1.2), 40);
}

TEST(ObjectTrackerTraffic, APredictionOfACarOnACircleLiesWithinItsStatedUncertainty) {
  const Traffic traffic = [](double t) {
    const double angle = -1.2 + 0.5 * t;
    return std::vector<MovingBox>{car(25 + 15 * std::cos(angle), 15 * std::sin(angle), angle + kQuarter, 7.5, 0.5)};
  };
  ObjectTracker tracker{TrackerConfig{}};
  for (int k = 0; k < 30; ++k) {
    const double t = k * kScanPeriod_s;
    const Objects objects = confirmed(step(tracker, view_of(traffic(t), t)));
    if (k < 8) {
      continue;
    }
    ASSERT_EQ(objects.size(), 1u) << "scan " << k;
    const ObjectPrediction& prediction = objects[0].prediction;
    const MovingBox truth = traffic(t + prediction.after_s)[0];
    const Vector3d error = prediction.centre - truth.box.centre;
    EXPECT_LT(dense::normalised_squared(error, prediction.centre_covariance), 9.0) << "scan " << k;
    // And it is of use.
    EXPECT_LT(error.head<2>().norm(), 1.0) << "scan " << k;
    EXPECT_LT(std::sqrt(prediction.centre_covariance.topLeftCorner<2, 2>().trace()), 2.5) << "scan " << k;
    EXPECT_LT((prediction.velocity_sensor - truth.velocity).norm(), 1.5) << "scan " << k;
  }
}

/// A lorry that comes at 6 m/s and turns aside after a second, and its trailer, whose axle does not slip.
std::vector<MovingBox> lorry_with_trailer(double t) {
  constexpr double kSpeed_mps = 6.0;
  constexpr double kJointBehind_m = 4.0;
  constexpr double kAxleBehind_m = 4.5;  // the joint, and there is the middle of the trailer
  constexpr double kStep_s = 1e-3;
  Vector3d middle(38.0, 4.0, 0.1);
  double yaw = std::numbers::pi;
  double trailer_yaw = yaw;
  double trailer_rate = 0.0;
  double rate = 0.0;
  const auto joint_velocity = [&] {
    const Eigen::Matrix3d axes = upright_axes(yaw);
    return Vector3d(kSpeed_mps * axes.col(0) - rate * kJointBehind_m * axes.col(1));
  };
  for (double now = 0.0; now < t; now += kStep_s) {
    rate = -0.4 * std::clamp(now - 1.0, 0.0, 1.0);
    trailer_rate = joint_velocity().dot(upright_axes(trailer_yaw).col(1)) / kAxleBehind_m;
    middle += kStep_s * kSpeed_mps * upright_axes(yaw).col(0);
    yaw += kStep_s * rate;
    trailer_yaw += kStep_s * trailer_rate;
  }
  const Eigen::Matrix3d axes = upright_axes(yaw);
  const Eigen::Matrix3d trailer_axes = upright_axes(trailer_yaw);
  const Vector3d trailer_middle = middle - kJointBehind_m * axes.col(0) - kAxleBehind_m * trailer_axes.col(0);
  const Vector3d trailer_velocity = joint_velocity() - trailer_rate * kAxleBehind_m * trailer_axes.col(1);
  return {{{middle, axes, {7.2, 2.4, 3.2}}, kSpeed_mps * axes.col(0), rate},
          {{trailer_middle, trailer_axes, {8.0, 2.4, 3.2}}, trailer_velocity, trailer_rate}};
}

TEST(ObjectTrackerTraffic, ALorryAndItsTrailerAreTwoWhenTheyBend) {
  ObjectTracker tracker{TrackerConfig{}};
  for (int k = 0; k < 40; ++k) {
    const double t = k * kScanPeriod_s;
    const Objects objects = confirmed(step(tracker, view_of(lorry_with_trailer(t), t)));
    if (k < 20) {
      continue;
    }
    ASSERT_EQ(objects.size(), 2u) << "scan " << k;
    for (const MovingBox& truth : lorry_with_trailer(t)) {
      const TrackedObject& object = nearest(objects, truth.box.centre);
      EXPECT_NEAR(object.yaw_rate_rps, truth.yaw_rate, 0.15) << "scan " << k;
      // Where their ends are is a guess until these are seen, and so are velocities of centres.
      EXPECT_LT(dense::normalised_squared(object.velocity_sensor - truth.velocity, object.covariance), 9.0)
          << "scan " << k;
      EXPECT_LT(dense::normalised_squared(object.box.centre - truth.box.centre, object.centre_covariance), 9.0)
          << "scan " << k;
    }
    EXPECT_EQ(objects[0].id, 1);
    EXPECT_EQ(objects[1].divided_from, 1);
  }
}

}  // namespace
}  // namespace dynamic_icp::tracking
