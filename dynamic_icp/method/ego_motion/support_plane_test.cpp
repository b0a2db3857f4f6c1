// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/support_plane.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/ego_motion/doppler_rows.hpp"

namespace dynamic_icp::ego_motion {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kHeight_m = 1.9;

/// What a sensor sees that is mounted at an angle, 1.9 m above a road, in a queue of lorries. As the camera of a car it
/// sees forward, z up, before it is turned.
struct Street {
  Matrix3d R_sensor_level = Eigen::AngleAxisd(0.7, Vector3d(0.3, 1.0, -0.5).normalized()).toRotationMatrix();
  std::mt19937 random{11};
  std::vector<Vector3d> points;
  std::vector<int> is_road;

  void add(double x, double y, double z, bool road) {
    std::normal_distribution<double> noise(0.0, 0.03);
    points.push_back(R_sensor_level * Vector3d(x + noise(random), y + noise(random), z + noise(random)));
    is_road.push_back(road ? 1 : 0);
  }
  [[nodiscard]] Scan scan() const {
    RawScan raw;
    raw.points = points;
    raw.doppler.assign(points.size(), 0.0);
    return Scan::from_raw(std::move(raw));
  }
  void add_road(std::size_t n) {
    std::uniform_real_distribution<double> ahead(4.0, 40.0);
    std::uniform_real_distribution<double> across(-10.0, 10.0);
    for (std::size_t k = 0; k < n; ++k) {
      add(ahead(random), across(random), -kHeight_m, true);
    }
  }
  /// Rises by a fifth beyond 6 m to the right.
  void add_embankment(std::size_t n) {
    std::uniform_real_distribution<double> ahead(4.0, 40.0);
    std::uniform_real_distribution<double> beyond(0.0, 14.0);
    for (std::size_t k = 0; k < n; ++k) {
      const double from_edge = beyond(random);
      add(ahead(random), -6.0 - from_edge, -kHeight_m + 0.2 * from_edge, false);
    }
  }
  /// The side of a lorry 2 m to the left, from the road to 2 m above the sensor.
  void add_lorry(std::size_t n) {
    std::uniform_real_distribution<double> along(0.0, 14.0);
    std::uniform_real_distribution<double> up(-kHeight_m, 2.0);
    for (std::size_t k = 0; k < n; ++k) {
      add(along(random), 2.0, up(random), false);
    }
  }
  /// Things of any shape above the road, on both sides of everything else.
  void add_clutter(std::size_t n) {
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (std::size_t k = 0; k < n; ++k) {
      add(25.0 + 20.0 * any(random), 15.0 * any(random), 2.0 + 3.0 * any(random), false);
    }
  }
};

void expect_road(const Street& street, const std::optional<SupportPlane>& plane) {
  ASSERT_TRUE(plane);
  const Vector3d up = street.R_sensor_level * Vector3d::UnitZ();
  EXPECT_GT(plane->normal.dot(up), std::cos(0.02)) << "up, where everything else is";
  EXPECT_NEAR(plane->offset_m, -kHeight_m, 0.15) << "the foot of the lorry is near it, too";
}

TEST(SupportPlane, IsTheRoadHoweverTheSensorIsMounted) {
  Street street;
  street.add_road(200);
  street.add_lorry(300);
  street.add_clutter(200);
  expect_road(street, find_support_plane(street.points));
}

TEST(SupportPlane, IsTheRoadWhereAnEmbankmentShowsMorePoints) {
  // Its plane bounds the scene, too: it passes 1.2 m below the road where the sensor is.
  Street street;
  street.add_road(150);
  street.points.erase(
      std::remove_if(street.points.begin(), street.points.end(),
                     [&](const Vector3d& x) { return (street.R_sensor_level.transpose() * x).y() < -6.0; }),
      street.points.end());
  street.add_embankment(400);
  street.add_clutter(100);
  const std::optional<SupportPlane> plane = find_support_plane(street.points);
  ASSERT_TRUE(plane);
  EXPECT_GT(plane->normal.dot(street.R_sensor_level * Vector3d::UnitZ()), std::cos(0.03));
  EXPECT_NEAR(plane->offset_m, -kHeight_m, 0.2);
}

TEST(SupportPlane, IsTheRoadBelowANearerCeiling) {
  Street street;
  street.add_road(300);
  std::uniform_real_distribution<double> ahead(4.0, 40.0);
  std::uniform_real_distribution<double> across(-10.0, 10.0);
  for (int k = 0; k < 200; ++k) {
    street.add(ahead(street.random), across(street.random), 0.8, false);
  }
  const std::optional<SupportPlane> plane = find_support_plane(street.points);
  ASSERT_TRUE(plane);
  EXPECT_GT(plane->normal.dot(street.R_sensor_level * Vector3d::UnitZ()), std::cos(0.02));
}

TEST(SupportPlane, IsNotTheSideOfALorry) {
  // Flat, all on one side of it, but not wide.
  Street street;
  street.add_lorry(600);
  EXPECT_FALSE(find_support_plane(street.points));
}

TEST(SupportPlane, IsNotTheUpperEdgeOfTheView) {
  // What bounds all that is seen: roofs that reach the upper edge of the field of view, 10 degrees above the sensor.
  Street street;
  std::uniform_real_distribution<double> ahead(10.0, 30.0);
  std::uniform_real_distribution<double> across(-10.0, 10.0);
  std::uniform_real_distribution<double> below(0.0, 12.0);
  for (int k = 0; k < 400; ++k) {
    const double x = ahead(street.random);
    street.add(x, across(street.random), 0.18 * x - (k % 2 == 0 ? below(street.random) : 0.0), false);
  }
  EXPECT_FALSE(find_support_plane(street.points));
}

TEST(SupportPlane, IsNothingThatHasPointsOnBothSides) {
  Street street;
  street.add_road(200);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int k = 0; k < 40; ++k) {  // a sixth of all: the road is a bridge, and there is something below
    street.add(25.0 + 15.0 * any(street.random), 10.0 * any(street.random), -8.0 + any(street.random), false);
  }
  const std::optional<SupportPlane> plane = find_support_plane(street.points);
  EXPECT_TRUE(!plane || std::abs(plane->offset_m + kHeight_m) > 1.0);
}

TEST(SupportPlane, OfNothingIsNone) {
  EXPECT_FALSE(find_support_plane({}));
  EXPECT_FALSE(find_support_plane(std::vector<Vector3d>(500, Vector3d(1.0, 2.0, 3.0))));
  std::vector<Vector3d> line;
  for (int k = 0; k < 500; ++k) {
    line.emplace_back(0.1 * k, 0.2 * k, 0.0);
  }
  EXPECT_FALSE(find_support_plane(line));
}

TEST(SupportPlane, SinglePointsBelowTheRoadDoNotHideIt) {
  Street street;
  street.add_road(6000);
  street.add_clutter(2000);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int k = 0; k < 60; ++k) {  // what it mirrors, all over
    street.add(22.0 + 18.0 * any(street.random), 10.0 * any(street.random), -6.0 + 3.0 * any(street.random), false);
  }
  const Scan scan = street.scan();
  spatial::CellOrder order;
  DopplerRows rows;
  sort_into_cells(scan, 2.0, Workers(1), order, rows);
  expect_road(street, find_support_plane(scan, order));
}

TEST(SupportPlane, CellsOnItHoldTheRoad) {
  Street street;
  street.add_road(3000);
  street.add_lorry(3000);
  street.add_clutter(1000);
  const Scan scan = street.scan();
  spatial::CellOrder order;
  DopplerRows rows;
  sort_into_cells(scan, 1.0, Workers(1), order, rows);
  expect_road(street, find_support_plane(scan, order));
  const std::vector<std::uint8_t> on = cells_on_support(scan, order, find_support_plane(scan, order).value());
  ASSERT_EQ(on.size(), rows.cells());
  std::size_t road = 0;
  std::size_t road_found = 0;
  std::size_t other_found = 0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    road += street.is_road[i] != 0 ? 1U : 0U;
    road_found += street.is_road[i] != 0 && on[order.cell[i]] != 0 ? 1U : 0U;
    other_found += street.is_road[i] == 0 && on[order.cell[i]] != 0 ? 1U : 0U;
  }
  EXPECT_GT(road_found, 9 * road / 10);
  EXPECT_LT(other_found, scan.size() / 20) << "but where the lorry's wheels stand";
}

}  // namespace
}  // namespace dynamic_icp::ego_motion
