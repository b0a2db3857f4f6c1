// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/box_view.hpp"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "testing/face_points.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::face_points;
using testing::kFaceStep_m;

TEST(BoxView, OfABodySeenFromBehindTheRearAndTheSidesAreSeen) {
  // The sensor is in the origin; nothing hides anything.
  const std::vector<Vector3d> rear = face_points({10.0, -0.9, -0.5}, {10.0, 0.9, 0.5});
  const auto [along, left, up] = views_along(Matrix3d::Identity(), {10.0, 0.0, 0.0}, rear, {5.0, 0.0, 0.0}, {});
  EXPECT_TRUE(along.low.is_true);
  EXPECT_FALSE(along.high.is_true) << "how long it is the body itself hides";
  EXPECT_TRUE(left.low.is_true);
  EXPECT_TRUE(left.high.is_true);
  EXPECT_NEAR(left.seen.low, -0.9, 1e-9);
  EXPECT_NEAR(left.seen.high, 0.9, 1e-9);
  EXPECT_NEAR(left.high.gap, kFaceStep_m, 1e-9);
  EXPECT_FALSE(up.low.is_true) << "what is below";
}

TEST(BoxView, OneSideDoesNotShowHowWideABodyIs) {
  // Beside the sensor, to its right: neither front nor rear look at it.
  const std::vector<Vector3d> side = face_points({-2.0, -5.0, -0.5}, {2.0, -5.0, 0.5});
  const auto [along, left, up] = views_along(Matrix3d::Identity(), {0.0, -5.0, 0.0}, side, {0.0, -5.0, 0.0}, {});
  EXPECT_TRUE(left.high.is_true) << "the side itself";
  EXPECT_FALSE(left.low.is_true) << "the far one";
  EXPECT_TRUE(along.low.is_true);
  EXPECT_TRUE(along.high.is_true);
}

TEST(BoxView, ABodyDoesNotEndWhereAFewOfItsPointsLieFarBeyond) {
  // The side of a lorry that goes on behind a van, over which three of five hundred points are seen.
  std::vector<Vector3d> side = face_points({-2.0, -5.0, -0.5}, {2.0, -5.0, 0.7});
  ASSERT_GT(side.size(), 400u);
  const auto ends = [&] {
    const AxisView along = views_along(Matrix3d::Identity(), {0, -5, 0}, side, {0.0, -5.0, 0.0}, {})[0];
    return std::pair(along.low.is_true, along.high.is_true);
  };
  side.emplace_back(2.9, -5.0, 0.7);
  EXPECT_EQ(ends(), std::pair(true, true)) << "one may be an error";
  side.emplace_back(3.6, -5.0, 0.7);
  side.emplace_back(4.2, -5.0, 0.7);
  EXPECT_EQ(ends(), std::pair(true, false));
}

TEST(BoxView, EndsThatHardlyMoveAlongTheLineOfSightMayGoOn) {
  // The same side moves along itself: its middle has no radial velocity, and points beyond its ends might be missing
  // among the moving ones where nothing is known of what stands.
  const std::vector<Vector3d> side = face_points({-0.2, -5.0, -0.5}, {2.0, -5.0, 0.5});
  const auto [along, left, up] = views_along(Matrix3d::Identity(), {0.0, -5.0, 0.0}, side, {8.0, 0.0, 0.0}, {});
  EXPECT_FALSE(along.low.is_true);
  EXPECT_TRUE(along.high.is_true);
}

TEST(BoxView, WhatContinuesASlowBodyIsPartOfItThoughItSeemsToStand) {
  // A side of which the points beyond one end are too slow along their lines of sight to be among the moving ones. With
  // nothing there but what is far behind it is an end.
  const std::vector<Vector3d> side = face_points({4.0, -8.0, -0.5}, {8.0, -8.0, 0.5});
  const Vector3d velocity(1.6, 0.0, 0.0);  // 0.7 m/s along the line of sight to the near end, and less beyond
  for (const bool continues : {true, false}) {
    RawScan raw;
    for (double x = continues ? 0.0 : 4.0; x <= 8.0; x += 0.02) {
      raw.points.emplace_back(x, -8.0, 0.0);
    }
    for (double x = 0.0; x <= 40.0; x += 0.05) {
      raw.points.emplace_back(x, -20.0, 0.0);
      raw.points.emplace_back(x, -20.0, -2.0);
    }
    raw.doppler.assign(raw.points.size(), 0.0);
    const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
    Detection detection;
    detection.view = &image;
    EXPECT_NE(views_along(Matrix3d::Identity(), {6.0, -8.0, 0.0}, side, velocity, detection)[0].low.is_true, continues);
  }
}

TEST(BoxView, WhereTheLowerPartIsHiddenTheEndOfTheUpperOneIsNone) {
  // The cabin of a car beside the sensor, seen over a wall that is nearer and hides hood and boot; without the wall,
  // and nothing seen there, the cabin is all there is.
  constexpr double kGround_m = -1.5;
  const std::vector<Vector3d> cabin = face_points({-1.2, -8.0, -0.6}, {1.2, -8.0, 0.0});
  for (const bool is_hidden : {false, true}) {
    RawScan raw;
    raw.points = cabin;
    for (double x = -4.0; x <= 4.0; x += 0.02) {
      raw.points.emplace_back(2.0 * x, -20.0, 0.0);  // behind all
      raw.points.emplace_back(2.0 * x, -20.0, 10.0);
      raw.points.emplace_back(x, -4.0, kGround_m);
      for (double z = kGround_m; z < -0.45 && is_hidden; z += 0.02) {
        raw.points.emplace_back(x, -5.0, z);
      }
    }
    raw.doppler.assign(raw.points.size(), 0.0);
    const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
    Detection detection;
    detection.ground.offset_m = kGround_m;
    detection.view = &image;
    const auto [along, left, up] =
        views_along(Matrix3d::Identity(), {0.0, -8.0, 0.0}, cabin, {5.0, -5.0, 0.0}, detection);
    for (const EndView& end : {along.high, along.low}) {
      EXPECT_NE(end.is_true, is_hidden);
      EXPECT_EQ(end.hidden, is_hidden ? 0.6 : 0.0) << "a hood or a boot";
    }
    EXPECT_TRUE(left.high.is_true) << "the side is seen";
  }
}

TEST(BoxView, WhereTheUpperPartIsHiddenTheEndOfTheLowerOneIsNone) {
  // The side of a van; a nearer lorry hides its front, and below the lorry a strip of it is seen up to a wheel.
  constexpr double kGround_m = -1.9;
  for (const bool is_hidden : {false, true}) {
    std::vector<Vector3d> side = face_points({-2.0, -8.0, -1.5}, {is_hidden ? 1.0 : 2.0, -8.0, 0.5});
    if (is_hidden) {
      const std::vector<Vector3d> strip = face_points({1.1, -8.0, -1.5}, {2.0, -8.0, -1.2});
      side.insert(side.end(), strip.begin(), strip.end());
    }
    RawScan raw;
    raw.points = side;
    for (double x = -4.0; x <= 4.0; x += 0.02) {
      raw.points.emplace_back(5.0 * x, -40.0, 0.0);  // behind all
      raw.points.emplace_back(5.0 * x, -40.0, -4.0);
      raw.points.emplace_back(x, -12.0, kGround_m);
      for (double z = -0.6; z < 1.0 && is_hidden && x > 0.65; z += 0.02) {
        raw.points.emplace_back(x, -5.0, z);
      }
    }
    raw.doppler.assign(raw.points.size(), 0.0);
    const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
    Detection detection;
    detection.ground.offset_m = kGround_m;
    detection.view = &image;
    const AxisView along = views_along(Matrix3d::Identity(), {0.0, -8.0, 0.0}, side, {5.0, -5.0, 0.0}, detection)[0];
    EXPECT_NE(along.high.is_true, is_hidden);
    EXPECT_TRUE(along.low.is_true);
  }
}

TEST(BoxView, WhatComesNextIsLookedForBehindTheLastPoints) {
  // Of the side of a body three of six hundred points are seen 0.3 m beyond the others, up to where a nearer wall
  // begins.
  std::vector<Vector3d> side = face_points({-2.0, -8.0, -0.5}, {1.0, -8.0, 1.4});
  for (const double z : {-0.5, -0.4, -0.3}) {
    side.emplace_back(1.3, -8.0, z);
  }
  ASSERT_GT(side.size(), 500u);
  for (const bool is_hidden : {false, true}) {
    RawScan raw;
    raw.points = side;
    for (double x = -4.0; x <= 4.0; x += 0.02) {
      raw.points.emplace_back(5.0 * x, -40.0, 0.0);
      for (double z = -1.0; z < 0.6 && is_hidden && x > 0.9; z += 0.02) {
        raw.points.emplace_back(x, -5.0, z);
      }
    }
    raw.doppler.assign(raw.points.size(), 0.0);
    const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
    Detection detection;
    detection.view = &image;
    const AxisView along = views_along(Matrix3d::Identity(), {0.0, -8.0, 0.0}, side, {5.0, -5.0, 0.0}, detection)[0];
    EXPECT_NE(along.high.is_true, is_hidden);
  }
}

TEST(BoxView, AFewPointsBehindASideMakeNoFaceOfItsEnd) {
  // The rear part of a lorry, the end of which looks at the sensor; a wall that is nearer hides whether it goes on. At
  // its end a tenth of what is seen is a wheel on its other side.
  std::vector<Vector3d> side = face_points({4.0, -5.0, -0.5}, {8.0, -5.0, 0.5});
  for (double z = -0.5; z < -0.2; z += kFaceStep_m) {
    side.emplace_back(4.1, -6.1, z);
  }
  const std::vector<Vector3d> rear = face_points({4.0, -6.5, -0.5}, {4.0, -5.0, 0.5});
  for (const bool is_face : {false, true}) {
    std::vector<Vector3d> body = side;
    body.insert(body.end(), rear.begin(), is_face ? rear.end() : rear.begin());
    RawScan raw;
    raw.points = body;
    for (double x = -2.0; x <= 2.0; x += 0.01) {
      for (double z = -0.5; z <= 0.5; z += 0.02) {
        raw.points.emplace_back(x - 0.05, -2.5, z);
      }
    }
    raw.doppler.assign(raw.points.size(), 0.0);
    const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
    Detection detection;
    detection.view = &image;
    const AxisView along = views_along(Matrix3d::Identity(), {6.0, -5.0, 0.0}, body, {5.0, -5.0, 0.0}, detection)[0];
    EXPECT_EQ(along.low.is_true, is_face);
  }
}

TEST(BoxView, OfWhatIsHighTheUpperPartEndsWhereTheLowerOneDoesButInFront) {
  // The same as above, of what is higher than any car, 8 m away, over something 5 m away: of a van, of a lorry of which
  // as much is hidden, and of one of which a cabin would be. What the upper edge of the view cuts off is likely to be a
  // lorry, where its height is not known.
  struct Case {
    double top_m;
    double hidden_below_m;
    double may_reach_m;                  // farther in front, in the mean
    bool is_cut = false;                 // by the upper edge of the view
    std::optional<double> known_m = {};  // height
  };
  constexpr double kGround_m = -1.5;
  for (const auto& [top_m, hidden_below_m, may_reach_m, is_cut, known_m] :
       {Case{2.4, 0.7, 0.6}, Case{3.0, 0.7, 0.0}, Case{3.6, 2.4, 1.2}, Case{2.4, 0.7, 0.0, true},
        Case{2.4, 0.7, 0.6, true, 2.5}}) {
    const std::vector<Vector3d> upper =
        face_points({-4.0, -8.0, kGround_m + hidden_below_m}, {4.0, -8.0, kGround_m + top_m});
    RawScan raw;
    raw.points = upper;
    for (double x = -6.0; x <= 6.0; x += 0.02) {
      raw.points.emplace_back(2.0 * x, -20.0, is_cut ? 0.0 : 10.0);
      for (double z = -1.5; z < 5.0 / 8.0 * (kGround_m + hidden_below_m); z += 0.02) {
        raw.points.emplace_back(x, -5.0, z);
      }
    }
    raw.doppler.assign(raw.points.size(), 0.0);
    const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
    Detection detection;
    detection.ground.offset_m = kGround_m;
    detection.view = &image;
    const std::optional<double> top = known_m ? std::optional(kGround_m + *known_m) : std::nullopt;
    const AxisView along =
        views_along(Matrix3d::Identity(), {0.0, -8.0, 0.0}, upper, {5.0, -5.0, 0.0}, detection, top)[0];
    EXPECT_EQ(along.high.is_true, may_reach_m == 0.0);
    EXPECT_EQ(along.high.hidden, may_reach_m) << "the front of what is " << top_m << " m high";
    EXPECT_TRUE(along.low.is_true);
    EXPECT_EQ(along.low.hidden, 0.0);
  }
}

TEST(BoxView, AFaceIsAnEndThoughSomethingHidesWhatIsBesideIt) {
  // A part of the rear of a body; a nearer thing hides all that is beside it. Of a side that leads away from the sensor
  // the same shows no end.
  const std::vector<Vector3d> rear = face_points({20.0, 5.0, -0.5}, {20.0, 6.0, 0.5});
  const std::vector<Vector3d> side = face_points({20.0, 6.0, -0.5}, {22.0, 6.0, 0.5});
  const std::vector<Vector3d> strip = face_points({20.0, 12.0, -0.5}, {20.0, 12.3, 0.5});
  const std::vector<Vector3d> block = face_points({20.0, 12.0, -0.5}, {20.3, 12.3, 0.5});
  RawScan raw;
  for (double azimuth = -0.8; azimuth <= 0.8; azimuth += 0.002) {
    for (double z = -1.0; z <= 1.0; z += 0.1) {
      raw.points.emplace_back(8.0 * std::cos(azimuth), 8.0 * std::sin(azimuth), z);
      raw.doppler.push_back(0.0);
    }
  }
  const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
  Detection detection;
  detection.view = &image;
  const auto views_of = [&](const std::vector<Vector3d>& body) {
    return views_along(Matrix3d::Identity(), body.front(), body, {5.0, 0.0, 0.0}, detection);
  };
  EXPECT_TRUE(views_of(rear)[0].low.is_true);
  EXPECT_FALSE(views_of(side)[0].low.is_true);
  EXPECT_TRUE(views_of(side)[1].low.is_true) << "the side itself, of which no end is seen";
  EXPECT_TRUE(views_of(strip)[0].low.is_true) << "narrow, but flat";
  EXPECT_FALSE(views_of(block)[0].low.is_true);
  // Seen at a small angle, a side is all the flatter; a strip of a level or slanted surface is not.
  const std::vector<Vector3d> oblique_side = face_points({20.0, -3.2, 0.0}, {22.0, -3.2, 0.5});
  std::vector<Vector3d> boot;
  for (double x = 20.0; x < 20.7; x += 0.05) {
    for (double y = -3.35; y < -3.2; y += 0.05) {
      boot.emplace_back(x, y, 0.5 * (x - 20.0));
    }
  }
  EXPECT_TRUE(views_of(oblique_side)[1].high.is_true);
  EXPECT_FALSE(views_of(boot)[1].high.is_true);
}

TEST(BoxView, APointFarFromAllOthersIsNoEnd) {
  std::vector<Vector3d> rear = face_points({10.0, -0.4, -0.3}, {10.0, 0.4, 0.2});
  ASSERT_LT(rear.size(), 100u);
  const auto left_end = [&] {
    return views_along(Matrix3d::Identity(), {10.0, 0.0, 0.0}, rear, {5.0, 0.0, 0.0}, {})[1].seen.high;
  };
  rear.emplace_back(9.5, 1.5, 0.0);
  EXPECT_NEAR(left_end(), 0.4, 1e-9);
  rear.emplace_back(9.5, 1.3, 0.0);
  EXPECT_NEAR(left_end(), 1.5, 1e-9) << "two may be of the body";
  const std::vector<Vector3d> two = {{10.0, -1.0, 0.0}, {10.0, 1.0, 0.0}};
  EXPECT_NEAR(views_along(Matrix3d::Identity(), two.front(), two, {5.0, 0.0, 0.0}, {})[1].seen.length(), 2.0, 1e-9);
}

TEST(BoxView, TheFarEndOfAFaceIsLookedForOnThatFace) {
  // The side of a lorry and a part of its rear, which the edge of the field of view cuts off. Through a gap some of the
  // lorry's other side is seen, straight behind which nothing would hide that it went on.
  std::vector<Vector3d> body = face_points({1.5, 2.0, -0.5}, {2.4, 2.0, 0.5});
  const std::vector<Vector3d> behind_gap = face_points({4.4, 2.0, -0.5}, {9.0, 2.0, 0.5});
  const std::vector<Vector3d> rear = face_points({1.5, 2.1, -0.5}, {1.5, 2.8, 0.5});
  const std::vector<Vector3d> through_gap = face_points({5.0, 2.6, -0.1}, {7.0, 2.8, -0.1});
  body.insert(body.end(), behind_gap.begin(), behind_gap.end());
  body.insert(body.end(), rear.begin(), rear.end());
  body.insert(body.end(), through_gap.begin(), through_gap.end());
  RawScan raw;
  raw.points = body;
  for (double azimuth = -1.0; azimuth <= std::atan2(2.8, 1.5); azimuth += 0.002) {
    for (double z = -6.0; z <= 6.0; z += 1.0) {
      raw.points.emplace_back(30.0 * std::cos(azimuth), 30.0 * std::sin(azimuth), z);
    }
  }
  raw.doppler.assign(raw.points.size(), 0.0);
  const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
  Detection detection;
  detection.view = &image;
  const auto [along, left, up] = views_along(Matrix3d::Identity(), {1.5, 2.0, 0.0}, body, {5.0, 5.0, 0.0}, detection);
  EXPECT_TRUE(along.low.is_true) << "the rear";
  EXPECT_TRUE(left.low.is_true) << "the side";
  EXPECT_FALSE(left.high.is_true);
}

TEST(BoxView, TheEdgeOfASideSeenEndOnIsNoEndWhereSomethingNearerBegins) {
  // The front part of a lorry in the next lane, 9 degrees off the line of sight; a nearer vehicle hides the rest.
  const std::vector<Vector3d> side = face_points({24.0, -4.0, 0.0}, {25.0, -4.0, 2.0});
  for (const bool is_hidden : {true, false}) {
    RawScan raw;
    raw.points = side;
    for (double y = -40.0; y < 20.0; y += 0.05) {
      for (double z = -1.0; z <= 2.5; z += 0.1) {
        raw.points.emplace_back(60.0, y, 3.0 * z);
      }
    }
    for (double y = -6.0; y < -10.0 * 4.0 / 23.9 && is_hidden; y += 0.01) {
      for (double z = -1.0; z <= 1.5; z += 0.02) {
        raw.points.emplace_back(10.0, y, z);
      }
    }
    raw.doppler.assign(raw.points.size(), 0.0);
    const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
    Detection detection;
    detection.view = &image;
    const AxisView along = views_along(Matrix3d::Identity(), side.front(), side, {5.0, 0.0, 0.0}, detection)[0];
    EXPECT_NE(along.low.is_true, is_hidden);
    EXPECT_FALSE(along.high.is_true) << "the far end of what is seen end-on";
  }
}

TEST(BoxView, AFrontOfWhichTheUpperPartIsHiddenEndsWhereItsHoodDoes) {
  // Of a car at the edge of the field of view 0.3 to 0.7 m above the road are seen, and below them nothing is.
  constexpr double kGround_m = -1.9;
  const std::vector<Vector3d> front = face_points({2.0, -9.0, -1.6}, {2.5, -9.0, -1.2});
  RawScan raw;
  raw.points = front;
  for (double x = -5.0; x <= 5.0; x += 0.05) {
    raw.points.emplace_back(1.5 * x, -14.0, kGround_m);  // the road behind it, and what bounds it
    raw.points.emplace_back(3.0 * x, -30.0, -1.0);
    raw.points.emplace_back(3.0 * x, -30.0, 2.0);
  }
  raw.doppler.assign(raw.points.size(), 0.0);
  const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
  Detection detection;
  detection.ground.offset_m = kGround_m;
  detection.view = &image;
  EXPECT_TRUE(views_along(Matrix3d::Identity(), front.front(), front, {5.0, -5.0, 0.0}, detection)[0].high.is_true);
}

}  // namespace
}  // namespace dynamic_icp::tracking
