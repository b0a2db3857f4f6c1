// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/ground_heights.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <thread>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Points of a road whose height is `height(x, y)`, and a few of walls on it.
template <class Height>
std::vector<Vector3d> road_points(const Height& height) {
  std::vector<Vector3d> points;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const RandomSource one = RandomSource(3).fork(i);
    const double x = one.uniform(0, -60, 60);
    const double y = one.uniform(1, -60, 60);
    const double above = i % 3 == 0 ? one.uniform(2, 0.0, 3.0) : 0.01 * one.normal(3);
    points.emplace_back(x, y, height(x, y) + above);
  }
  return points;
}

Scan as_scan(const std::vector<Vector3d>& points) {
  RawScan raw;
  raw.points = points;
  raw.doppler.assign(points.size(), 0.0);
  return Scan::from_raw(raw);
}

TEST(GroundHeights, FollowARoadThatBends) {
  const auto height = [](double x, double) { return -1.8 + 1e-4 * x * x; };
  const Scan scan = as_scan(road_points(height));
  const std::vector<std::uint8_t> is_moving(scan.size(), 0);
  ScanPatches patches;
  patches.bound(scan, Workers(1));
  GroundHeights heights;
  heights.begin({Matrix3d::Identity(), -1.8}, scan.points(), patches, is_moving, Eigen::Isometry3d::Identity());
  for (const double x : {-50.0, -20.0, 0.0, 33.0, 55.0}) {
    const std::optional<double> offset = heights.below({x, 10.0, height(x, 10.0) + 0.5}).offset_m;
    ASSERT_TRUE(offset);
    EXPECT_NEAR(*offset, height(x, 10.0), 0.1) << "x = " << x;
  }
}

/// What a leaning sensor that has turned sees of a hilly road, column by column.
struct HillyRoad {
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();
  Scan scan;
  std::vector<std::uint8_t> is_moving;
  ScanPatches patches;
  std::vector<Vector3d> places;  ///< world, all over it and beyond

  HillyRoad() {
    T_world_sensor.linear() = exp_so3({0.05, -0.08, 2.0});
    T_world_sensor.translation() = Vector3d(30.0, -12.0, 4.0);
    std::vector<Vector3d> points =
        road_points([](double x, double y) { return -1.8 + 0.3 * std::sin(0.1 * x - 0.07 * y); });
    std::ranges::sort(points, {}, [](const Vector3d& point) { return std::atan2(point.y(), point.x()); });
    const Matrix3d R_sensor_world = T_world_sensor.linear().transpose();
    for (Vector3d& point : points) {
      point = R_sensor_world * point;
    }
    scan = as_scan(points);
    is_moving.assign(scan.size(), 0);
    for (std::size_t row = 0; row < scan.size(); row += 7) {
      is_moving[row] = 1;
    }
    patches.bound(scan, Workers(1));
    for (std::uint64_t i = 0; i < 400; ++i) {
      const RandomSource one = RandomSource(8).fork(i);
      const Vector3d from_sensor(one.uniform(0, -110, 110), one.uniform(1, -110, 110), one.uniform(2, -2.0, -1.0));
      places.push_back(T_world_sensor.translation() + from_sensor);
    }
  }

  void show(GroundHeights& heights) const {
    heights.begin({Matrix3d::Identity(), 4.0 - 1.8}, scan.points(), patches, is_moving, T_world_sensor);
  }

  /// The height of the ground below a place: the mean of the bin of 5 cm with most static points in the four cells of
  /// 6 m that are nearest, and of the bins beside it; if those are too few, of more cells.
  [[nodiscard]] std::optional<double> offset_below(const Vector3d& place) const {
    for (int reach = 1; reach <= 3; ++reach) {
      std::vector<int> bins(24);
      for (std::size_t row = 0; row < scan.size(); ++row) {
        const Vector3d point = T_world_sensor.linear() * scan.points()[row];
        bool is_near = is_moving[row] == 0 && point.head<2>().cwiseAbs().maxCoeff() < 96.0;
        for (int axis = 0; axis < 2; ++axis) {
          const int cells = static_cast<int>(std::floor(point[axis] / 6.0)) -
                            static_cast<int>(std::lround((place[axis] - T_world_sensor.translation()[axis]) / 6.0));
          is_near = is_near && cells >= -reach && cells < reach;
        }
        const double bin = std::floor((point.z() + 1.8) / 0.05) + 12.0;
        if (is_near && bin >= 0.0 && bin < 24.0) {
          ++bins[static_cast<std::size_t>(bin)];
        }
      }
      const auto most = std::ranges::max_element(bins) - bins.begin();
      double count = 0.0;
      double sum = 0.0;
      for (auto i = std::max<std::ptrdiff_t>(0, most - 1); i <= std::min<std::ptrdiff_t>(23, most + 1); ++i) {
        count += bins[static_cast<std::size_t>(i)];
        sum += bins[static_cast<std::size_t>(i)] * 0.05 * (static_cast<double>(i) - 11.5);
      }
      if (count >= 6.0) {
        return 2.2 + sum / count;
      }
    }
    const double above = place.z() - 2.2;
    return above > -0.3 && above < 1.0 ? std::optional(2.2) : std::nullopt;
  }
};

TEST(GroundHeights, AreThoseOfAllPointsThoughFewAreLookedAt) {
  const HillyRoad road;
  GroundHeights heights;
  std::size_t found = 0;
  for (const Vector3d& place : road.places) {
    road.show(heights);  // nothing was asked before
    const std::optional<double> expected = road.offset_below(place);
    const std::optional<double> offset = heights.below(place).offset_m;
    ASSERT_EQ(offset.has_value(), expected.has_value()) << place.transpose();
    if (offset) {
      EXPECT_NEAR(*offset, *expected, 1e-9) << place.transpose();
      found += *offset != 2.2 ? 1 : 0;
    }
  }
  EXPECT_GT(found, 80u) << "more than the plane is known at many places";
  EXPECT_LT(found, 300u) << "some places are beyond the road";
}

TEST(GroundHeights, AreTheSameInWhateverOrderTheyAreAskedFor) {
  const HillyRoad road;
  GroundHeights forth;
  GroundHeights back;
  road.show(forth);
  road.show(back);
  const std::size_t n = road.places.size();
  std::vector<std::optional<double>> one(n);
  std::vector<std::optional<double>> other(n);
  for (std::size_t i = 0; i < n; ++i) {
    one[i] = forth.below(road.places[i]).offset_m;
  }
  const auto ask = [&](std::size_t first) {
    for (std::size_t i = first; i < n; i += 2) {
      other[n - 1 - i] = back.below(road.places[n - 1 - i]).offset_m;
    }
  };
  std::thread even([&] { ask(0); });
  ask(1);
  even.join();
  EXPECT_EQ(one, other);
}

TEST(GroundHeights, WithoutPointsThePlaneCountsUnlessItIsFarBelow) {
  const GroundHeights heights({Matrix3d::Identity(), -1.8});
  EXPECT_EQ(heights.below({20, 0, -1.5}).offset_m, -1.8);
  EXPECT_FALSE(heights.below({20, 0, 0.5}).offset_m);
  EXPECT_FALSE(heights.below({20, 0, -2.5}).offset_m);
  EXPECT_FALSE(GroundHeights().below({20, 0, 0.5}).offset_m) << "no plane is known";
}

TEST(GroundHeights, BelowWhatIsHiddenFromBelowThePlaneMayBeFarther) {
  const GroundHeights heights({Matrix3d::Identity(), -1.8});
  EXPECT_EQ(heights.below({100, 0, 0.5}, true).offset_m, -1.8);
  EXPECT_FALSE(heights.below({100, 0, 0.5}, false).offset_m);
  const auto on_slope = heights.below({100, 0, 1.5}, true).offset_m;
  ASSERT_TRUE(on_slope);
  EXPECT_NEAR(*on_slope, -1.5, 1e-12) << "3 m below what is seen: the road rises";
  EXPECT_FALSE(heights.below({100, 0, 3.5}, true).offset_m) << "but not by 2.3 m in 100";
  EXPECT_FALSE(heights.below({10, 0, 1.7}, true).offset_m) << "nor by 0.5 m in 10";
}

TEST(GroundHeights, NearTheSensorWhatIsAboveThePlaneIsNotTheGround) {
  // Below the field of view no road is seen; some reflections are half a metre above it. Far away roads bend so much.
  for (const double range : {6.0, 60.0}) {
    RawScan raw;
    for (int i = 0; i < 40; ++i) {
      raw.points.emplace_back(range + 0.02 * i, 0.1 * (i % 7), -1.35);
      raw.doppler.push_back(0.0);
    }
    const Scan scan = Scan::from_raw(raw);
    ScanPatches patches;
    patches.bound(scan, Workers(1));
    const std::vector<std::uint8_t> is_moving(scan.size(), 0);
    GroundHeights heights;
    heights.begin({Matrix3d::Identity(), -1.8}, scan.points(), patches, is_moving, Eigen::Isometry3d::Identity());
    EXPECT_NEAR(*heights.below({range, 0.0, -1.2}).offset_m, range < 10.0 ? -1.8 : -1.35, 0.03);
  }
}

}  // namespace
}  // namespace dynamic_icp::tracking
