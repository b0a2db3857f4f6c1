// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/static_map.hpp"

#include <array>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace dynamic_icp::report {
namespace {

Eigen::Isometry3d pose(double x, double yaw) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(x, 0.0, 0.0);
  return T;
}

/// Points of the wall y = 5 of the world, 0 to 50 m along it, in sensor axes.
std::vector<Eigen::Vector3d> wall(const Eigen::Isometry3d& T_world_sensor, double step_m) {
  std::vector<Eigen::Vector3d> points;
  for (double x = 0.0; x < 50.0; x += step_m) {
    for (double z = 0.0; z < 3.0; z += step_m) {
      points.emplace_back(T_world_sensor.inverse() * Eigen::Vector3d(x, 5.0, z));
    }
  }
  return points;
}

TEST(StaticMap, LiesWhereTheWorldIs) {
  StaticMap map(1'000'000);
  for (int k = 0; k < 5; ++k) {
    const Eigen::Isometry3d T = pose(2.0 * k, 0.3 * k);
    map.add(wall(T, 0.25), T);
  }
  const std::vector<Eigen::Vector3d> points = map.points();
  EXPECT_EQ(map.cell_m(), StaticMap::kFinestCell_m);
  EXPECT_GE(points.size(), 200u * 12u) << "each of 200 x 12 places is a cell of its own";
  for (const Eigen::Vector3d& point : points) {
    EXPECT_NEAR(point.y(), 5.0, 1e-9);
    EXPECT_TRUE(point.x() > -1e-9 && point.x() < 50.0 && point.z() > -1e-9 && point.z() < 3.0);
  }
}

TEST(StaticMap, CellsGrowUntilItFits) {
  StaticMap map(300);
  const Eigen::Isometry3d T = pose(0.0, 0.0);
  map.add(wall(T, 0.1), T);
  const std::vector<Eigen::Vector3d> points = map.points();
  EXPECT_LE(points.size(), 300u);
  EXPECT_GT(points.size(), 100u);
  EXPECT_GT(map.cell_m(), 0.5);
  std::set<std::array<double, 3>> cells;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d cell = point / map.cell_m();
    EXPECT_TRUE(cells.insert({std::floor(cell.x()), std::floor(cell.y()), std::floor(cell.z())}).second);
  }
  map.limit(50);
  EXPECT_LE(map.points().size(), 50u);
}

TEST(StaticMap, LeavesOutWhatIsNowhere) {
  StaticMap map(10);
  map.add(std::vector<Eigen::Vector3d>{{1e300, 0.0, 0.0}, {0.0, std::nan(""), 0.0}, {1.0, 2.0, 3.0}}, pose(0.0, 0.0));
  ASSERT_EQ(map.points().size(), 1u);
  EXPECT_EQ(map.points().front(), Eigen::Vector3d(1.0, 2.0, 3.0));
}

}  // namespace
}  // namespace dynamic_icp::report
