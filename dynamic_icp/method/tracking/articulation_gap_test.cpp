// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/tracking/articulation.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

constexpr double kRoad_m = -1.8;
constexpr double kLorryFront_m = 20.0;  // its side is 4 m to the left of the sensor
constexpr double kLorryTop_m = 2.2;
const Vector3d kOncoming(-8.0, 0.0, 0.0);

/// The side of what comes towards the sensor, with a gap at one place above the axles.
struct LorrySide {
  double length_m = 16.5;
  double gap_at_m = 2.6;  ///< behind the front
  double gap_m = 0.8;
  double lowest_m = kRoad_m + 0.4;  ///< of the gap
  Vector3d velocity = kOncoming;
  std::uint64_t seed = 1;
};

/// A scan of it, and what it shows beside the points.
struct SideView {
  RawScan raw;
  Detection detection;
};

SideView side_seen(const LorrySide& side) {
  SideView view;
  view.detection.ground.offset_m = kRoad_m;
  const RandomSource random(side.seed);
  for (std::uint64_t i = 0; view.raw.points.size() < 500; ++i) {
    const double behind_m = side.length_m * std::pow(random.fork(i).uniform(0), 1.5);  // the near part is seen better
    const Vector3d point(kLorryFront_m + behind_m, 4.0, random.fork(i).uniform(1, kRoad_m + 0.5, kLorryTop_m));
    if (std::abs(behind_m - side.gap_at_m) < 0.5 * side.gap_m && point.z() > side.lowest_m) {
      continue;
    }
    view.raw.points.push_back(point);
  }
  view.raw.doppler.assign(view.raw.points.size(), 0.0);
  return view;
}

OrientedBox box_of(const LorrySide& side) {
  return {{kLorryFront_m + 0.5 * side.length_m, 4.0, 0.5 * (kRoad_m + kLorryTop_m)},
          Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitZ()).toRotationMatrix(),
          {side.length_m, 2.5, kLorryTop_m - kRoad_m}};
}

std::optional<Joint> gap_of(const LorrySide& side, const SideView& view) {
  const Scan scan = Scan::from_raw(view.raw);
  std::vector<std::uint32_t> rows(scan.size());
  std::iota(rows.begin(), rows.end(), 0);
  return find_gap({scan, rows, SensorMotion{}, view.detection}, box_of(side), side.velocity);
}

std::optional<Joint> gap_of(const LorrySide& side) { return gap_of(side, side_seen(side)); }

TEST(ArticulationGap, LiesBetweenCabAndTrailer) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const double at_m : {2.6, 7.0}) {
      const std::optional<Joint> joint = gap_of({.gap_at_m = at_m, .gap_m = at_m < 5.0 ? 0.8 : 1.5, .seed = seed});
      ASSERT_TRUE(joint) << "seed " << seed << " at " << at_m;
      EXPECT_TRUE(joint->is_gap);
      EXPECT_FALSE(joint->is_across);
      EXPECT_NEAR(joint->direction.x(), -1.0, 1e-9);
      EXPECT_NEAR(-joint->place_m, kLorryFront_m + at_m, 0.2) << "up to the spacing of points, seed " << seed;
    }
  }
}

TEST(ArticulationGap, IsSeenThoughLittleFollowsIt) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_TRUE(gap_of({.length_m = 13.5, .gap_at_m = 10.8, .gap_m = 1.6, .seed = seed}))
        << "the first two metres of a trailer that comes into view, seed " << seed;
  }
}

TEST(ArticulationGap, GoesDownToTheAxlesNoFarther) {
  EXPECT_TRUE(gap_of({.lowest_m = kRoad_m + 1.2})) << "a drawbar, or the frame of the tractor";
  EXPECT_FALSE(gap_of({.lowest_m = kRoad_m + 2.5})) << "a window";
}

TEST(ArticulationGap, PartsNothingThatRoadsAllowOneBody) {
  EXPECT_FALSE(gap_of({.length_m = 12.0})) << "a lorry: between the cab and what it carries there is a gap, too";
}

TEST(ArticulationGap, AWideOneMayPartABodyFromWhatIsOfAnother) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::optional<Joint> joint = gap_of({.length_m = 10.0, .gap_at_m = 1.8, .gap_m = 1.9, .seed = seed});
    ASSERT_TRUE(joint) << "the rear of a lorry before its trailer, seed " << seed;
    EXPECT_TRUE(joint->is_of_another);
    EXPECT_NEAR(-joint->place_m, kLorryFront_m + 1.8, 0.2) << "seed " << seed;
    EXPECT_FALSE(gap_of({.gap_at_m = 7.0, .gap_m = 1.9, .seed = seed})->is_of_another) << "of two for sure";
  }
}

TEST(ArticulationGap, IsNoneWhereTheSideIsWhole) {
  int gaps = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    gaps += gap_of({.gap_m = 0.0, .seed = seed}) ? 1 : 0;
  }
  EXPECT_LE(gaps, 1) << "of 200 sides that were hit anywhere";
}

TEST(ArticulationGap, IsNoneWhereTheBodyHardlyMovesAlongTheSight) {
  const Vector3d sight = Vector3d(kLorryFront_m + 2.6, 4.0, 0.0).normalized();
  EXPECT_FALSE(gap_of({.velocity = 8.0 * Vector3d::UnitZ().cross(sight)}))
      << "points without radial velocity are not among the moving ones";
}

TEST(ArticulationGap, IsUnknownWithoutGround) {
  SideView view = side_seen({});
  view.detection.ground.offset_m.reset();
  EXPECT_FALSE(gap_of({}, view));
}

TEST(ArticulationGap, IsNoneBehindSomethingNearer) {
  const LorrySide side;
  const Vector3d gap(kLorryFront_m + side.gap_at_m, 4.0, 0.0);
  for (const bool is_hidden : {false, true}) {
    SideView view = side_seen(side);
    RawScan all = view.raw;
    for (double across = -3.0; across <= 3.0; across += 0.05) {
      for (double z = kRoad_m; z < 6.0; z += 0.2) {
        all.points.emplace_back(60.0, 4.0 * across, z);  // what is behind all
        if (is_hidden && std::abs(across) <= 0.3) {
          all.points.emplace_back(0.5 * gap.x(), 0.5 * gap.y() + across, 0.5 * z);  // a post
        }
      }
    }
    all.doppler.assign(all.points.size(), 0.0);
    const RangeImage image(Scan::from_raw(all), Vector3d::Zero(), Workers(1));
    view.detection.view = &image;
    EXPECT_NE(gap_of(side, view).has_value(), is_hidden);
  }
}

}  // namespace
}  // namespace dynamic_icp::tracking
