// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/range_image.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

/// A wall of directions `from` to `to` (degrees of azimuth) at a range.
void add_wall(RawScan& raw, double from, double to, double range) {
  for (double azimuth = from; azimuth <= to; azimuth += 0.2) {
    for (double elevation = -5.0; elevation <= 5.0; elevation += 0.5) {
      const double a = azimuth * std::numbers::pi / 180.0;
      const double e = elevation * std::numbers::pi / 180.0;
      raw.points.emplace_back(range * Vector3d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)));
      raw.doppler.push_back(0.0);
    }
  }
}

Vector3d at(double azimuth, double range) {
  return range *
         Vector3d(std::cos(azimuth * std::numbers::pi / 180.0), std::sin(azimuth * std::numbers::pi / 180.0), 0.0);
}

TEST(RangeImage, NearThingsHideWhatIsBehindThem) {
  RawScan raw;
  add_wall(raw, -60.0, 60.0, 50.0);
  add_wall(raw, -10.0, 10.0, 20.0);
  const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
  EXPECT_TRUE(image.hides(at(5.0, 30.0), 1.0));
  EXPECT_FALSE(image.hides(at(5.0, 20.5), 1.0)) << "within the clearance";
  EXPECT_FALSE(image.hides(at(5.0, 10.0), 1.0)) << "before it";
  EXPECT_FALSE(image.hides(at(15.0, 30.0), 1.0)) << "beside it";
  EXPECT_TRUE(image.hides(at(15.0, 60.0), 1.0));
}

TEST(RangeImage, BeyondTheFieldOfViewAllIsHidden) {
  RawScan raw;
  add_wall(raw, -60.0, 60.0, 50.0);
  const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
  EXPECT_TRUE(image.hides(at(65.0, 10.0), 1.0));
  EXPECT_TRUE(image.hides(at(61.2, 10.0), 1.0)) << "just beyond its edge";
  EXPECT_FALSE(image.hides(at(59.5, 10.0), 1.0));
  EXPECT_TRUE(image.hides(at(180.0, 10.0), 1.0));
  EXPECT_TRUE(RangeImage(Scan{}, Vector3d::Zero(), Workers(1)).hides(at(0.0, 10.0), 1.0));
}

TEST(RangeImage, BelowAllThatIsSeenAllIsHidden) {
  RawScan raw;
  add_wall(raw, -60.0, 60.0, 50.0);  // level: nothing is seen below
  const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
  EXPECT_FALSE(image.hides({10.0, 0.0, 0.0}, 1.0));
  EXPECT_TRUE(image.hides({10.0, 0.0, -3.0}, 1.0));
  EXPECT_FALSE(image.hides({10.0, 0.0, 3.0}, 1.0)) << "above there may be sky";
}

TEST(RangeImage, BetweenLinesOfSightThatAreFarApartNothingIsHidden) {
  RawScan raw;
  for (double azimuth = -60.0; azimuth <= 60.0; azimuth += 0.6) {  // every other column or so
    raw.points.push_back(at(azimuth, 50.0));
    raw.doppler.push_back(0.0);
  }
  const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
  for (double azimuth = -58.9; azimuth < 59.0; azimuth += 0.1) {
    EXPECT_FALSE(image.hides(at(azimuth, 10.0), 1.0)) << azimuth;
  }
}

TEST(RangeImage, WithANegativeClearanceWhatIsFartherHidesToo) {
  RawScan raw;
  add_wall(raw, -60.0, 60.0, 50.0);
  add_wall(raw, -10.0, 10.0, 20.0);
  const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
  EXPECT_TRUE(image.hides(at(5.0, 18.0), -3.0)) << "something is seen 2 m farther";
  EXPECT_FALSE(image.hides(at(5.0, 16.0), -3.0));
  EXPECT_FALSE(image.hides(at(15.0, 46.0), -3.0));
}

TEST(RangeImage, TheGroundBeforeAThingDoesNotHideIt) {
  // Level ground 1.5 m below the sensor, and a wall 60 m away: nothing is between the sensor and a car.
  RawScan raw;
  for (double azimuth = -20.0; azimuth <= 20.0; azimuth += 0.2) {
    for (double elevation = -15.0; elevation <= 5.0; elevation += 0.2) {
      const double a = azimuth * std::numbers::pi / 180.0;
      const double e = elevation * std::numbers::pi / 180.0;
      const Vector3d u(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
      raw.points.emplace_back(std::min(60.0, u.z() < 0.0 ? -1.5 / u.z() : 60.0) * u);
      raw.doppler.push_back(0.0);
    }
  }
  const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
  for (const double range : {10.0, 20.0, 30.0, 40.0, 50.0}) {
    EXPECT_FALSE(image.hides({range, 1.0, -0.7}, 1.0)) << "0.8 m above the ground, range " << range;
  }
}

TEST(RangeImage, SeesWhatLiesOnAWay) {
  // A wall along a road, at an angle of a few degrees, with nothing on the last part.
  RawScan raw;
  for (double x = 20.0; x <= 26.0; x += 0.5) {
    for (double z = -1.0; z <= 2.0; z += 0.5) {
      raw.points.emplace_back(x, 3.0, z);
    }
  }
  raw.doppler.assign(raw.points.size(), 0.0);
  const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
  EXPECT_TRUE(image.sees_along({22.0, 3.0, 0.0}, {28.0, 3.0, 0.0}, 1.0));
  EXPECT_TRUE(image.sees_along({22.0, 3.0, -3.0}, {28.0, 3.0, -3.0}, 2.5)) << "its lower part";
  EXPECT_FALSE(image.sees_along({26.5, 3.0, 0.0}, {32.0, 3.0, 0.0}, 1.0)) << "behind it";
  EXPECT_FALSE(image.sees_along({22.0, 4.5, 0.0}, {28.0, 4.5, 0.0}, 1.0)) << "beside it";
  EXPECT_FALSE(image.sees_along({22.0, 3.0, 3.5}, {28.0, 3.0, 3.5}, 1.0)) << "over it";
  EXPECT_FALSE(RangeImage().sees_along({22.0, 3.0, 0.0}, {28.0, 3.0, 0.0}, 1.0)) << "where nothing is seen";
}

TEST(RangeImage, KnowsHowHighItSees) {
  RawScan raw;
  add_wall(raw, -60.0, 60.0, 50.0);  // up to 5 degrees, 4.4 m there
  const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
  EXPECT_FALSE(image.is_above_all({50.0, 0.0, 4.0}));
  EXPECT_FALSE(image.is_above_all({20.0, 30.0, 0.0}));
  EXPECT_TRUE(image.is_above_all({50.0, 0.0, 7.0}));
  EXPECT_TRUE(image.is_above_all({10.0, 0.0, 1.4})) << "8 degrees";
  EXPECT_TRUE(image.is_above_all({-50.0, 0.0, 7.0})) << "in whatever direction";
}

/// Whether all rows are taken for mirrored, of some points behind a wall in all directions to 20 degrees, twelve of
/// them spread from `from` to `to` degrees; `every`: the wall is a fence with a gap at every so many of its rays.
bool mirrored_behind_wall(double from, double to, int every) {
  RawScan raw;
  std::vector<std::uint32_t> rows;
  std::vector<std::uint32_t> memory;
  add_wall(raw, -20.0, 20.0, 5.0);
  if (every > 0) {
    for (std::size_t i = 0; i < raw.points.size(); i += static_cast<std::size_t>(every)) {
      if (const double azimuth = std::atan2(raw.points[i].y(), raw.points[i].x()) * 180.0 / std::numbers::pi;
          azimuth >= from && azimuth <= to) {
        raw.points[i] *= 2.0;
        rows.push_back(static_cast<std::uint32_t>(i));
      }
    }
  } else {
    for (int i = 0; i < 12; ++i) {
      rows.push_back(static_cast<std::uint32_t>(raw.points.size()));
      raw.points.push_back(at(from + (to - from) * i / 12.0, 10.0));
      raw.doppler.push_back(0.0);
    }
  }
  RangeImage(Scan::from_raw(raw), Vector3d::Zero(), Workers(1)).remove_mirrored(rows, memory);
  return rows.empty();
}

TEST(RangeImage, FewPointsThatSeemToBeBehindASurfaceAreMirrored) {
  EXPECT_TRUE(mirrored_behind_wall(-15.0, 15.0, 0));
  EXPECT_FALSE(mirrored_behind_wall(21.5, 30.0, 0)) << "beside the wall";
  EXPECT_FALSE(mirrored_behind_wall(15.0, 30.0, 0)) << "a body that it hides in part";
  EXPECT_FALSE(mirrored_behind_wall(-10.0, 10.0, 2)) << "a fence";
}

TEST(RangeImage, OfABodyWhatIsSeenThroughSomethingNearerIsRemoved) {
  // A body beside a wall, three points that seem to be of it behind the wall, and in the wall a slit of 0.3 degrees,
  // through which its edge is seen.
  RawScan raw;
  std::vector<std::uint32_t> rows;
  std::vector<std::uint32_t> memory;
  const auto add = [&](double azimuth) {
    rows.push_back(static_cast<std::uint32_t>(raw.points.size()));
    raw.points.push_back(at(azimuth, 10.0));
    raw.doppler.push_back(0.0);
  };
  for (const double azimuth : {12.0, 14.0, 17.0}) {
    add(azimuth);
  }
  for (double azimuth = 19.8; azimuth < 25.0; azimuth += 0.1) {
    add(azimuth);
  }
  const std::vector<std::uint32_t> body(rows.begin() + 3, rows.end());
  add_wall(raw, -20.0, 20.0, 5.0);
  RangeImage(Scan::from_raw(raw), Vector3d::Zero(), Workers(1)).remove_mirrored(rows, memory);
  EXPECT_EQ(rows, body);
}

}  // namespace
}  // namespace dynamic_icp::tracking
