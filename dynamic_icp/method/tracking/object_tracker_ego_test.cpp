// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>

#include <gtest/gtest.h>

#include "dynamic_icp/method/tracking/object_tracker.hpp"

#include "testing/boxes_in_view.hpp"

namespace dynamic_icp::tracking {
namespace {

// What stands and seems to move, since the velocity of the sensor is wrong.

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kMoves_mps = 0.25;

/// The view where the velocity of the sensor is off by so much.
View with_wrong_velocity(View view, const Vector3d& error) {
  for (std::size_t row = 0; row < view.radial.size(); ++row) {
    view.radial[row] += view.scan.directions()[row].dot(error);
    view.is_moving[row] = std::abs(view.radial[row]) > kMoves_mps ? 1 : 0;
  }
  return view;
}

/// In the first scan, whatever is not known of their headings.
std::vector<TrackedObject> confirmed_with(const View& view, double ego_sigma_mps) {
  TrackerConfig config;
  config.confirm_anyway_scans = 1;
  ObjectTracker tracker{config};
  const auto objects =
      tracker.update(view.scan, view.radial, view.is_moving, SensorMotion{}, ground_from(Eigen::Isometry3d::Identity()),
                     Workers(1), ego_sigma_mps * ego_sigma_mps * Matrix3d::Identity());
  return confirmed({objects.begin(), objects.end()});
}

TEST(ObjectTrackerEgo, WhatMovesWithinTheErrorOfTheSensorIsNotConfirmed) {
  const MovingBox block{{{15.0, 5.0, -0.5}, Matrix3d::Identity(), {2.0, 2.0, 2.0}}, Vector3d::Zero(), 0.0};
  const MovingBox driving = car(20, -4, 0.0, 8);
  const View view = with_wrong_velocity(view_of({block, driving}, 0.0), {0.6, 0.0, 0.0});
  EXPECT_GT(confirmed_with(view, 0.01).size(), 1U) << "the block must be one that could be taken for an object";
  const std::vector<TrackedObject> objects = confirmed_with(view, 0.5);
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_LT((objects[0].centroid - driving.box.centre).head<2>().norm(), 1.0);
}

TEST(ObjectTrackerEgo, TheGroundIsNoObject) {
  View view = view_of({}, 0.0);
  std::size_t points = 0;
  for (std::size_t row = 0; row < view.radial.size(); ++row) {
    const Vector3d& point = view.scan.points()[row];
    if (point.x() > 8.0 && point.x() < 13.0 && std::abs(point.y()) < 1.0 && point.z() < -1.3) {
      view.radial[row] = 0.6 * view.scan.directions()[row].x();
      view.is_moving[row] = 1;
      ++points;
    }
  }
  ASSERT_GT(points, 100U);
  ObjectTracker tracker{TrackerConfig{}};
  EXPECT_TRUE(step(tracker, view).empty());
}

}  // namespace
}  // namespace dynamic_icp::tracking
