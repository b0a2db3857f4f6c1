// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/track_merging.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

/// The side that looks at the sensor of a box that drives along x, from `from` to `to`; 8 m to the left of the sensor.
Track side_of_body(double from, double to, double speed_mps, double top_m = 0.5) {
  Detection detection;
  for (std::uint64_t i = 0; i < 300; ++i) {
    const RandomSource one = RandomSource(5).fork(i);
    detection.points.emplace_back(one.uniform(0, from, to), 8.0, one.uniform(1, -1.0, top_m));
    detection.directions.push_back(detection.points.back().normalized());
    detection.radial.push_back(speed_mps * detection.directions.back().x());
    detection.times.push_back(0.0);
  }
  return {detection, 0.0, {}};
}

/// The rear, which looks at the sensor, of a box that drives along x, from `right` to `left` of the x axis.
Track rear_of_body(double x, double right, double left, double speed_mps) {
  Detection detection;
  for (std::uint64_t i = 0; i < 300; ++i) {
    const RandomSource one = RandomSource(7).fork(i);
    detection.points.emplace_back(x, one.uniform(0, right, left), one.uniform(1, -1.0, 0.5));
    detection.directions.push_back(detection.points.back().normalized());
    detection.radial.push_back(speed_mps * detection.directions.back().x());
    detection.times.push_back(0.0);
  }
  return {detection, 0.0, {}};
}

/// What is seen to the left: a wall at this distance.
RangeImage wall_at(double distance_m) {
  RawScan raw;
  for (double x = -2.0; x <= 18.0; x += 0.05) {
    for (double z = -1.5; z <= 1.5; z += 0.12) {
      raw.points.push_back(distance_m / 8.0 * Vector3d(x, 8.0, z));
      raw.doppler.push_back(0.0);
    }
  }
  return {Scan::from_raw(raw), Vector3d::Zero(), Workers(1)};
}

bool are_same(const Track& a, std::size_t points_of_a, const Track& b, std::size_t points_of_b, double wall_m = 60.0) {
  const BoxEstimate of_a = a.estimate();
  const BoxEstimate of_b = b.estimate();
  const SeenTrack one{a, of_a, points_of_a};
  const SeenTrack other{b, of_b, points_of_b};
  const RangeImage view = wall_at(wall_m);
  const bool result = are_same_object(one, other, view, Eigen::Isometry3d::Identity(), {});
  EXPECT_EQ(result, are_same_object(other, one, view, Eigen::Isometry3d::Identity(), {})) << "either way round";
  return result;
}

TEST(TrackMerging, WhatIsSeenInAnotherIsTheSame) {
  EXPECT_TRUE(are_same(side_of_body(3, 7, 6), 300, side_of_body(4, 6, 6), 200));
  EXPECT_TRUE(are_same(side_of_body(3, 7, 6), 300, side_of_body(4, 6, 12), 0)) << "however it moves, seen or not";
}

TEST(TrackMerging, ASplinterBesideABodyIsAPartIfItMovesAsItDoes) {
  const Track body = side_of_body(3, 7, 6);
  EXPECT_TRUE(are_same(body, 300, side_of_body(7.3, 8.0, 6), 20));
  EXPECT_FALSE(are_same(body, 300, side_of_body(7.3, 8.0, 14), 20)) << "faster";
  EXPECT_FALSE(are_same(body, 300, side_of_body(7.3, 8.0, 6), 0)) << "hidden";
  EXPECT_FALSE(are_same(body, 300, side_of_body(20, 21, 6), 20)) << "far off";
}

TEST(TrackMerging, ASplinterThatReachesFarInALaneIsAPart) {
  // The upper part of the side of a lorry, seen over a van that hides where it joins the rest.
  const Track body = side_of_body(0, 6, 6, 2.0);
  EXPECT_TRUE(are_same(body, 300, side_of_body(6.9, 9.5, 6, 2.0), 20, 4.0));
  EXPECT_FALSE(are_same(body, 300, side_of_body(6.9, 9.5, 6, 2.0), 200, 4.0)) << "no splinter";
  EXPECT_FALSE(are_same(body, 300, side_of_body(6.9, 9.5, 6, 2.0), 20, 60.0)) << "the gap is seen through";
}

TEST(TrackMerging, WhatIsSeenThroughAGapPartsTwoBodies) {
  const Track rear = side_of_body(0, 4, 6, 2.0);
  const Track front = side_of_body(4.5, 8.0, 6, 2.0);
  EXPECT_FALSE(are_same(rear, 300, front, 250, 60.0));
  EXPECT_TRUE(are_same(rear, 300, front, 250, 4.0)) << "something nearer hides the gap";
  EXPECT_FALSE(are_same(rear, 300, side_of_body(11, 15, 6, 2.0), 250, 4.0)) << "too far apart";
}

TEST(TrackMerging, NoTwoBodiesAreInOnePlace) {
  // Two parts of the side of a lorry, of which each is taken for all of it: each box holds the centre of the other.
  const Track rear = side_of_body(0, 4, 6, 2.0);
  const Track front = side_of_body(4.5, 8.0, 6, 2.0);
  BoxEstimate of_rear = rear.estimate();
  BoxEstimate of_front = front.estimate();
  const RangeImage view = wall_at(60.0);
  const auto are_one = [&] {
    return are_same_object({rear, of_rear, 300}, {front, of_front, 250}, view, Eigen::Isometry3d::Identity(), {});
  };
  for (BoxEstimate* one : {&of_rear, &of_front}) {
    one->box.size.x() = 8.0;
  }
  of_rear.box.centre = Vector3d(3.0, 9.0, 0.5);
  of_front.box.centre = Vector3d(5.0, 9.2, 0.5);
  EXPECT_TRUE(are_one()) << "though the gap is seen through";
  of_front.box.centre.x() = 8.0;
  EXPECT_FALSE(are_one()) << "one behind the other";
  of_front.box.centre.x() = 5.0;
  of_front.velocity.x() += 8.0;
  EXPECT_FALSE(are_one()) << "faster";
}

TEST(TrackMerging, WhatWasSeenAtLastSaysHowWideTwoAreTogether) {
  // Two strips of the rear of a lorry; the box of one of them has drifted away sideways.
  const auto strip = [](double from_y, double to_y) {
    Detection detection;
    for (std::uint64_t i = 0; i < 200; ++i) {
      const RandomSource one = RandomSource(8).fork(i);
      detection.points.emplace_back(30.0, one.uniform(0, from_y, to_y), one.uniform(1, -1.0, 2.0));
      detection.directions.push_back(detection.points.back().normalized());
      detection.radial.push_back(8.0 * detection.directions.back().x());
      detection.times.push_back(0.0);
    }
    return detection;
  };
  const Detection left = strip(4.6, 5.8);
  const Detection drifted = strip(3.0, 4.5);
  const Track a(left, 0.0, {});
  const Track b(drifted, 0.0, {});
  const BoxEstimate of_a = a.estimate();
  const BoxEstimate of_b = b.estimate();
  const auto are_one = [&](const Detection& right) {
    RawScan raw;
    for (double y = 2.0; y <= 7.0; y += 0.05) {
      for (double z = -1.0; z <= 2.0; z += 0.1) {
        raw.points.emplace_back(30.0, y, z);
        raw.doppler.push_back(0.0);
      }
    }
    const RangeImage view(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
    return are_same_object({a, of_a, 200, left.points}, {b, of_b, 180, right.points}, view,
                           Eigen::Isometry3d::Identity(), {});
  };
  EXPECT_TRUE(are_one(strip(3.4, 4.5))) << "2.4 m";
  EXPECT_FALSE(are_one(drifted)) << "2.8 m";
  EXPECT_FALSE(are_one(Detection{})) << "as wide as the boxes";
}

TEST(TrackMerging, BodiesThatWouldBeLongerThanAnyOrHaveOtherTopsAreTwo) {
  // One behind the other in a lane, with the same speed, and something nearer hides the gap.
  EXPECT_FALSE(are_same(side_of_body(0, 4, 6), 300, side_of_body(4.5, 8.0, 6), 250, 4.0)) << "of a height of 1.5 m";
  EXPECT_FALSE(are_same(side_of_body(0, 4, 6, 2.0), 300, side_of_body(4.5, 8.0, 6, 0.5), 250, 4.0))
      << "a lorry and a car";
}

TEST(TrackMerging, NothingOfABodyLiesBeforeItsFaces) {
  const Track side = side_of_body(12, 18, 6);
  EXPECT_FALSE(are_same(side, 300, rear_of_body(14, 6.2, 7.5, 6), 300, 4.0))
      << "a rear before a side that begins before it";
  EXPECT_TRUE(are_same(side, 300, rear_of_body(12, 6.2, 7.9, 6), 300, 4.0)) << "a corner";
}

TEST(TrackMerging, FarPartsThatWouldBeAsWideAsABodyButForErrorsAreOne) {
  // Rear and front of a lorry whose headings differ by 0.02 rad: at 110 m this is no other body.
  const auto are_one = [](double distance_m, double turn_rad) {
    const auto part = [&](double from, double to, double yaw) {
      const Eigen::Vector3d middle(distance_m, 8.0, 0.0);
      const Eigen::Matrix3d R = upright_axes(yaw);
      Detection detection;
      for (std::uint64_t i = 0; i < 300; ++i) {
        const RandomSource one = RandomSource(6).fork(i);
        const double across = i % 2 == 0 ? -1.3 : one.uniform(1, -1.3, 1.3);
        const double along = i % 2 == 0 ? one.uniform(0, from, to) : from;
        detection.points.emplace_back(middle + R * Vector3d(along, across, one.uniform(2, -1.0, 2.5)));
        detection.directions.push_back(detection.points.back().normalized());
        detection.radial.push_back(15.0 * detection.directions.back().x());
        detection.times.push_back(0.0);
      }
      return Track(detection, 0.0, {});
    };
    const Track rear = part(0.0, 4.0, 0.0);
    const Track front = part(4.3, 8.0, turn_rad);
    const BoxEstimate of_rear = rear.estimate();
    const BoxEstimate of_front = front.estimate();
    RawScan raw;
    for (double y = 4.0; y <= 12.0; y += 0.02) {
      for (double z = -2.0; z <= 3.0; z += 0.1) {
        raw.points.emplace_back(distance_m - 5.0, y, z);
        raw.doppler.push_back(0.0);
      }
    }
    const RangeImage view(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
    return are_same_object({rear, of_rear, 300}, {front, of_front, 250}, view, Eigen::Isometry3d::Identity(), {});
  };
  EXPECT_TRUE(are_one(110.0, 0.0));
  EXPECT_TRUE(are_one(110.0, 0.02));
  EXPECT_FALSE(are_one(110.0, 0.12)) << "it would be wider than any";
}

}  // namespace
}  // namespace dynamic_icp::tracking
