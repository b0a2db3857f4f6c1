// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/tracking/box_view.hpp"

#include "testing/face_points.hpp"

// Bodies of which something nearer, or the edge of the field of view, cuts off a part.
namespace dynamic_icp::tracking {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::face_points;

RangeImage image_of(RawScan raw) {
  raw.doppler.assign(raw.points.size(), 0.0);
  return {Scan::from_raw(raw), Vector3d::Zero(), Workers(1)};
}

TEST(BoxView, WhatReachesTheUpperEdgeOfTheViewIsCut) {
  const std::vector<Vector3d> side = face_points({-2.0, -5.0, -0.5}, {2.0, -5.0, 0.8});
  for (const double highest : {0.8, 1.2}) {  // m at the distance of the side: what is seen elsewhere
    RawScan raw;
    raw.points = side;
    for (double x = -20.0; x <= 20.0; x += 0.05) {
      raw.points.emplace_back(x, -20.0, 4.0 * highest);
    }
    const RangeImage image = image_of(std::move(raw));
    Detection detection;
    detection.view = &image;
    const AxisView up = views_along(Matrix3d::Identity(), {0, -5, 0}, side, {5.0, -5.0, 0.0}, detection)[2];
    EXPECT_EQ(up.high.is_cut, highest == 0.8);
  }
}

TEST(BoxView, WhatTheUpperEdgeOfTheViewCutsOffMayGoOn) {
  // A strip of the side of a lorry, right below the upper edge of the view: what is nearer would be seen above that.
  // Where something else is seen higher up, the view ends elsewhere.
  const std::vector<Vector3d> strip = face_points({4.0, -5.5, 1.4}, {7.0, -5.5, 1.4});
  for (const bool is_edge : {true, false}) {
    RawScan raw;
    raw.points = strip;
    for (double x = -20.0; x <= 40.0; x += 0.05) {
      raw.points.emplace_back(x, -20.0, 0.0);
    }
    if (!is_edge) {
      raw.points.emplace_back(20.0, 0.0, 10.0);
    }
    const RangeImage image = image_of(std::move(raw));
    Detection detection;
    detection.ground.offset_m = -2.0;
    detection.view = &image;
    const AxisView along = views_along(Matrix3d::Identity(), strip.front(), strip, {5.0, -5.0, 0.0}, detection)[0];
    EXPECT_NE(along.low.is_true, is_edge);
  }
}

TEST(BoxView, BehindAWindowSeenOverSomethingNearerMayBeABoot) {
  // What is seen of the rear of a car 30 m away, from some height on, which leans or not.
  constexpr double kGround_m = -1.8;
  struct Case {
    double from_m;  // over ground
    double lean;    // m per m
    double boot_m;
  };
  for (const auto& [from_m, lean, boot_m] : {Case{0.95, 1.0, 0.4}, Case{0.95, 0.1, 0.0}, Case{0.55, 1.0, 0.0}}) {
    std::vector<Vector3d> rear;
    for (double z = from_m; z < 1.45; z += 0.05) {
      for (double y = -0.7; y <= 0.7; y += 0.1) {
        rear.emplace_back(30.0 + lean * (z - from_m), y, kGround_m + z);
      }
    }
    Detection detection;
    detection.ground.offset_m = kGround_m;
    const EndView end = views_along(Matrix3d::Identity(), rear.front(), rear, {5.0, 0.0, 0.0}, detection)[0].low;
    EXPECT_EQ(end.is_true, boot_m == 0.0);
    EXPECT_EQ(end.hidden, boot_m);
  }
}

TEST(BoxView, AFewPointsSideBySideAreNoFace) {
  // The hood of a car, of which the edge of the view cuts off the rest, and the last of its points there.
  std::vector<Vector3d> hood = face_points({20.4, 10.0, -0.5}, {22.0, 11.5, -0.5});
  for (const double beside : {0.0, 0.03, 0.06}) {
    hood.emplace_back(20.0, 10.5 + beside, -0.5);
  }
  RawScan raw;
  raw.points = hood;
  const RangeImage image = image_of(std::move(raw));
  Detection detection;
  detection.view = &image;
  const AxisView along = views_along(Matrix3d::Identity(), hood.front(), hood, {5.0, 0.0, 0.0}, detection)[0];
  ASSERT_GE(along.low.count, 3.0);
  EXPECT_FALSE(along.low.is_true);
}

TEST(BoxView, TheRearEndsWhereTheSideIsSeenPastIt) {
  // A part of the rear of a lorry 40 m away, up to its left side; a wall hides all that would be to the left of it. The
  // side itself is seen at an angle of 7 degrees. Points of a roof reach as far as the wall lets them.
  const std::vector<Vector3d> rear = face_points({40.0, -6.2, -1.0}, {40.0, -4.8, 1.0});
  std::vector<Vector3d> side;
  std::vector<Vector3d> roof;
  for (double x = 41.0; x <= 46.0; x += 1.0) {
    side.emplace_back(x, -4.8, 0.5);
    roof.emplace_back(x, -4.8 * x / 40.0, 1.0);
  }
  RawScan raw;
  for (double y = -2.4; y <= 2.0; y += 0.02) {
    for (double z = -1.0; z <= 2.0; z += 0.05) {
      raw.points.emplace_back(20.0, y, z);
    }
  }
  raw.points.insert(raw.points.end(), rear.begin(), rear.end());
  const RangeImage image = image_of(std::move(raw));
  Detection detection;
  detection.view = &image;
  const auto ends_left = [&](const std::vector<Vector3d>& beyond) {
    std::vector<Vector3d> body = rear;
    body.insert(body.end(), beyond.begin(), beyond.end());
    return views_along(Matrix3d::Identity(), rear.front(), body, {5.0, 0.0, 0.0}, detection)[1].high.is_true;
  };
  EXPECT_FALSE(ends_left({}));
  EXPECT_FALSE(ends_left(roof));
  EXPECT_TRUE(ends_left(side));
}

TEST(BoxView, TheRearOfALorryThatComesIsSeenAtASmallAngle) {
  // The far end of its side, seen at 6 degrees: front and side, and behind them a wall far off.
  const double front_m = 20.0;
  const auto lorry = [&](double rear_m, double height_m) {
    std::vector<Vector3d> points = face_points({front_m, 3.0, -1.0}, {front_m, 5.4, height_m - 1.5});
    for (double x = front_m; x <= rear_m; x += 0.3) {
      for (double z = -1.0; z <= height_m - 1.5; z += 0.3) {
        points.emplace_back(x, 3.0, z);
      }
    }
    return points;
  };
  const auto ends_at_rear = [&](const std::vector<Vector3d>& body, const std::vector<Vector3d>& others) {
    RawScan raw;
    for (double y = -20.0; y <= 40.0; y += 0.4) {
      for (double z = -2.0; z <= 20.0; z += 0.5) {
        raw.points.emplace_back(90.0, y, z);
      }
    }
    raw.points.insert(raw.points.end(), body.begin(), body.end());
    raw.points.insert(raw.points.end(), others.begin(), others.end());
    const RangeImage image = image_of(std::move(raw));
    Detection detection;
    detection.view = &image;
    detection.ground.offset_m = -1.5;
    return views_along(upright_axes(std::numbers::pi), body.front(), body, {-8.0, 0.0, 0.0}, detection)[0].low.is_true;
  };
  EXPECT_TRUE(ends_at_rear(lorry(28.0, 3.5), {}));
  EXPECT_FALSE(ends_at_rear(lorry(28.0, 1.5), {})) << "cars have boots";
  EXPECT_FALSE(ends_at_rear(lorry(23.0, 3.5), {})) << "no lorry is so short";
  // More of its side, of which the points are no part of what moves.
  EXPECT_FALSE(ends_at_rear(lorry(28.0, 3.5), {{31.0, 3.0, 0.5}, {31.5, 3.0, 1.0}}));
  EXPECT_TRUE(ends_at_rear(lorry(28.0, 3.5), {{31.0, 3.0, -1.4}, {38.0, 3.0, 0.5}})) << "the ground, and the next one";
}

}  // namespace
}  // namespace dynamic_icp::tracking
