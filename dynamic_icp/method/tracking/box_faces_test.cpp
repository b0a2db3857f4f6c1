// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <numbers>

#include <gtest/gtest.h>

#include "dynamic_icp/method/tracking/box_filter.hpp"

#include "testing/face_points.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

constexpr double kRear_m = 30.0;

/// The rear of a lorry that moves away from the sensor, or its front if it comes.
Detection end_of_lorry(double speed_mps) {
  Detection detection;
  detection.points = testing::face_points({kRear_m, -1.2, -1.0}, {kRear_m, 1.2, 1.5});
  for (const Vector3d& point : detection.points) {
    detection.directions.push_back(point.normalized());
    detection.radial.push_back(detection.directions.back().x() * speed_mps);
    detection.times.push_back(0.0);
  }
  return detection;
}

Detection rear_of_lorry() { return end_of_lorry(12.0); }
Detection front_of_lorry() { return end_of_lorry(-12.0); }

/// What is seen of something as wide and high between two places ahead of the sensor.
OrientedBox part(double from_m, double to_m) {
  return {{0.5 * (from_m + to_m), 0.0, 0.25}, Eigen::Matrix3d::Identity(), {to_m - from_m, 2.4, 2.5}};
}

double front_of(const OrientedBox& box) { return box.centre.x() + 0.5 * box.size.x(); }

TEST(BoxFaces, ABodyReachesAsFarAsItsParts) {
  const TrackConfig config;
  BoxFilter filter(rear_of_lorry(), 0.0, {}, config);
  ASSERT_LT(front_of(filter.estimate().box), 40.0) << "a lorry of the likely length";
  filter.include(part(41.0, 44.0), false);
  EXPECT_NEAR(front_of(filter.seen_box()), 44.0, 0.01);
  EXPECT_GE(front_of(filter.estimate().box), 44.0 - 0.01);
  filter.include(part(35.0, 38.0), false);
  EXPECT_NEAR(front_of(filter.seen_box()), 44.0, 0.01) << "shorter parts say nothing";
}

TEST(BoxFaces, AnEndThatIsSeenIsNotMovedBySplinters) {
  const TrackConfig config;
  BoxFilter filter(rear_of_lorry(), 0.0, {}, config);
  const OrientedBox before = filter.estimate().box;
  filter.include(part(26.0, 28.0), true);
  const OrientedBox after = filter.estimate().box;
  EXPECT_NEAR(after.centre.x(), before.centre.x(), 1e-9);
  EXPECT_NEAR(after.size.x(), before.size.x(), 1e-9);
}

TEST(BoxFaces, BeyondAnEndThereIsNoLargePart) {
  const TrackConfig config;
  BoxFilter filter(rear_of_lorry(), 0.0, {}, config);
  filter.include(part(26.0, 28.0), false);
  const BoxEstimate after = filter.estimate();
  EXPECT_LT(after.box.centre.x() - 0.5 * after.box.size.x(), 26.0 + 0.01) << "it comes into view";
  EXPECT_EQ(after.faces[index_of(Face::kRear)], FaceView::kUnknown);
}

TEST(BoxFaces, OnlyBehindCabsAFrameGoesOnBelowTheTrailer) {
  const TrackConfig config;
  for (const double length_m : {2.4, 9.0}) {
    BoxFilter filter(rear_of_lorry(), 0.0, {}, config);
    filter.end_at(Vector3d::UnitX(), kRear_m + length_m);
    EXPECT_NEAR(filter.estimate().box.size.x(), length_m, 0.5) << "it ends ahead";
    BoxFilter backwards(front_of_lorry(), std::numbers::pi, {}, config);
    backwards.end_at(Vector3d::UnitX(), kRear_m + length_m);
    EXPECT_NEAR(backwards.estimate().box.size.x(), length_m + (length_m < 4.0 ? 3.6 : 0.0), 0.5);
  }
}

TEST(BoxFaces, WhatIsLongAndHighIsNoStrip) {
  // Beside the cab before it a part of the front of a trailer is seen, and its side: of a body that was divided, too.
  const TrackConfig config;
  const auto body_of = [&](double width_m, double height_m, bool is_part) {
    Detection detection;
    detection.points = testing::face_points({kRear_m, 3.0, -1.5}, {kRear_m, 3.0 + width_m, height_m - 1.5});
    for (const Vector3d& point : testing::face_points({kRear_m, 3.0, -1.5}, {kRear_m + 10.0, 3.0, height_m - 1.5})) {
      detection.points.push_back(point);
    }
    for (const Vector3d& point : detection.points) {
      detection.directions.push_back(point.normalized());
      detection.radial.push_back(detection.directions.back().x() * -8.0);
      detection.times.push_back(0.0);
    }
    BoxFilter filter(detection, std::numbers::pi, {}, config);
    if (is_part) {
      filter.end_at(-Vector3d::UnitX(), -kRear_m);
      filter.correct(detection, config);
    }
    return filter.estimate().box;
  };
  for (const bool is_part : {false, true}) {
    const OrientedBox trailer = body_of(1.4, 4.0, is_part);
    EXPECT_NEAR(trailer.size.y(), 2.5, 0.3) << "part " << is_part;
    EXPECT_NEAR(trailer.centre.y() - 0.5 * trailer.size.y(), 3.0, 0.2) << "part " << is_part;
    EXPECT_NEAR(body_of(2.4, 4.0, is_part).size.y(), 2.4, 0.1) << "as wide as was seen, part " << is_part;
    EXPECT_NEAR(body_of(1.4, 2.0, is_part).size.y(), 1.4, 0.1) << "cars differ more, part " << is_part;
  }
}

TEST(BoxFaces, WithoutHeadingABodyHasNoEnds) {
  const TrackConfig config;
  BoxFilter filter(rear_of_lorry(), std::nullopt, {}, config);
  const OrientedBox before = filter.seen_box();
  filter.include(part(41.0, 44.0), false);
  EXPECT_NEAR(filter.seen_box().size.x(), before.size.x(), 1e-9);
}

}  // namespace
}  // namespace dynamic_icp::tracking
