// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/mapping/plane_map.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace dynamic_icp::mapping {
namespace {

using Eigen::Vector3d;

const Workers kOneThread(1);

/// A floor at `height` around a place, sampled at random.
std::vector<Vector3d> floor_at(double height, const Vector3d& place, unsigned seed, std::size_t count = 6000) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-6.0, 6.0);
  std::normal_distribution<double> noise(0.0, 0.005);
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back(place + Vector3d(uniform(random), uniform(random), height + noise(random)));
  }
  return points;
}

TEST(PlaneMap, FindsNothingBeforeThereIsAnything) {
  const PlaneMap map({});
  EXPECT_TRUE(map.empty());
  EXPECT_EQ(map.find(Vector3d::Zero()), nullptr);
  EXPECT_EQ(map.patch_limit(), 0u);
}

TEST(PlaneMap, FindsTheFloorFromItsCoarsestCells) {
  PlaneMap map({});
  map.add(floor_at(0.3, Vector3d::Zero(), 1), Vector3d::Zero(), kOneThread);
  const Patch* patch = map.find(Vector3d(1.1, -2.3, 0.4));
  ASSERT_NE(patch, nullptr);
  EXPECT_NEAR(std::abs(patch->plane.normal.z()), 1.0, 1e-4);
  EXPECT_NEAR(std::abs(patch->plane.distance(Vector3d(1.1, -2.3, 0.4))), 0.1, 3e-3);
  EXPECT_GT(patch->plane.points, 100.0) << "a cell of two metres, not of half a metre";
  EXPECT_LT(patch->id, map.patch_limit());
  EXPECT_EQ(map.find(Vector3d(1.1, -2.3, 5.0)), nullptr) << "nothing is up there";
}

TEST(PlaneMap, DividesACellThatHoldsAnEdge) {
  // Floor and wall meet at x = 1, inside the coarse cell [0, 2).
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0.0, 2.0);
  std::vector<Vector3d> points;
  for (int i = 0; i < 4000; ++i) {
    points.emplace_back(0.5 * uniform(random), uniform(random), 0.02);
    points.emplace_back(1.02, uniform(random), uniform(random));
  }
  PlaneMap map({});
  map.add(points, Vector3d::Zero(), kOneThread);
  const Patch* floor = map.find(Vector3d(0.3, 1.2, 0.0));
  const Patch* wall = map.find(Vector3d(1.0, 1.2, 1.3));
  ASSERT_NE(floor, nullptr);
  ASSERT_NE(wall, nullptr);
  EXPECT_NEAR(std::abs(floor->plane.normal.z()), 1.0, 1e-6);
  EXPECT_NEAR(std::abs(wall->plane.normal.x()), 1.0, 1e-6);
}

TEST(PlaneMap, ForgetsOldScans) {
  // The floor rises by 6 cm: soon the map believes the later scans.
  PlaneMapConfig config;
  config.memory_scans = 2.0;
  PlaneMap map(config);
  map.add(floor_at(0.30, Vector3d::Zero(), 1), Vector3d::Zero(), kOneThread);
  for (unsigned k = 0; k < 10; ++k) {
    map.add(floor_at(0.36, Vector3d::Zero(), 2 + k), Vector3d::Zero(), kOneThread);
  }
  const Patch* patch = map.find(Vector3d(1.1, 1.3, 0.36));
  ASSERT_NE(patch, nullptr);
  EXPECT_NEAR(patch->plane.mean.z(), 0.36, 2e-3);
}

TEST(PlaneMap, WithoutMemoryHoldsTheLastScanOnly) {
  PlaneMapConfig config;
  config.memory_scans = 0.0;
  PlaneMap map(config);
  map.add(floor_at(0.3, Vector3d::Zero(), 1), Vector3d::Zero(), kOneThread);
  map.add(floor_at(0.4, Vector3d(3.0, 0.0, 0.0), 2), Vector3d::Zero(), kOneThread);
  EXPECT_EQ(map.find(Vector3d(-4.5, 0.5, 0.3)), nullptr) << "only in the first scan";
  const Patch* patch = map.find(Vector3d(1.1, 1.3, 0.4));
  ASSERT_NE(patch, nullptr);
  EXPECT_NEAR(patch->plane.mean.z(), 0.4, 1e-3);
}

TEST(PlaneMap, DropsWhatIsFarFromTheSensor) {
  PlaneMapConfig config;
  config.max_range_m = 50.0;
  PlaneMap map(config);
  map.add(floor_at(0.3, Vector3d::Zero(), 1), Vector3d::Zero(), kOneThread);
  const std::uint32_t limit = map.patch_limit();
  map.add(floor_at(0.3, Vector3d(100.0, 0.0, 0.0), 2), Vector3d(100.0, 0.0, 0.0), kOneThread);
  EXPECT_EQ(map.find(Vector3d(1.1, 1.3, 0.3)), nullptr);
  EXPECT_NE(map.find(Vector3d(101.1, 1.3, 0.3)), nullptr);
  EXPECT_LT(map.patch_limit(), 2 * limit);
}

TEST(PlaneMap, LeavesOutPointsBeyondItsReach) {
  PlaneMap map({});
  const std::vector<Vector3d> points = {{1e9, 0.0, 0.0}, {0.0, std::nan(""), 0.0}, {0.1, 0.1, 0.1}};
  map.add(points, Vector3d::Zero(), kOneThread);
  EXPECT_EQ(map.find(points[0]), nullptr);
  EXPECT_EQ(map.find(points[1]), nullptr);
}

TEST(PlaneMap, DoesNotDependOnTheThreads) {
  const Workers three(3);
  PlaneMap a({});
  PlaneMap b({});
  for (unsigned k = 0; k < 3; ++k) {
    const std::vector<Vector3d> points = floor_at(0.3, Vector3d(k, 0.0, 0.0), k);
    a.add(points, Vector3d::Zero(), kOneThread);
    b.add(points, Vector3d::Zero(), three);
  }
  for (const Vector3d& point : floor_at(0.3, Vector3d::Zero(), 9, 500)) {
    const Patch* left = a.find(point);
    const Patch* right = b.find(point);
    ASSERT_EQ(left == nullptr, right == nullptr);
    if (left != nullptr) {
      EXPECT_EQ(left->id, right->id);
      EXPECT_EQ(left->plane.mean, right->plane.mean);
      EXPECT_EQ(left->plane.normal, right->plane.normal);
    }
  }
}

TEST(PlaneMap, RefusesImpossibleConfigurations) {
  PlaneMapConfig config;
  config.levels = 0;
  EXPECT_THROW(PlaneMap{config}, std::invalid_argument);
}

}  // namespace
}  // namespace dynamic_icp::mapping
