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
  EXPECT_TRUE(image.hides(at(180.0, 10.0), 1.0));
  EXPECT_TRUE(RangeImage(Scan{}, Vector3d::Zero(), Workers(1)).hides(at(0.0, 10.0), 1.0));
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

TEST(RangeImage, ColumnsAroundAPlaceHoldAllPointsThere) {
  RawScan raw;
  for (double azimuth = 0.0; azimuth < 360.0; azimuth += 0.1) {
    raw.points.push_back(at(azimuth, 20.0));
    raw.doppler.push_back(0.0);
  }
  const Scan scan = Scan::from_raw(raw);
  const RangeImage image(scan, Vector3d::Zero(), Workers(3));
  for (double azimuth = 0.0; azimuth < 360.0; azimuth += 7.0) {
    const Vector3d centre = at(azimuth, 21.0);
    const RangeImage::ColumnRange range = RangeImage::columns_around(centre, 3.0);
    for (std::size_t row = 0; row < scan.size(); ++row) {
      const int offset = (image.columns()[row] - range.first + RangeImage::column_count()) % RangeImage::column_count();
      if ((scan.points()[row] - centre).norm() <= 3.0) {
        EXPECT_LT(offset, range.count) << "azimuth " << azimuth << " row " << row;
      }
    }
    EXPECT_LT(range.count, RangeImage::column_count() / 8);
  }
  EXPECT_EQ(RangeImage::columns_around(at(0.0, 1.0), 3.0).count, RangeImage::column_count()) << "the sensor is inside";
}

}  // namespace
}  // namespace dynamic_icp::tracking
