// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/mapping/plane_map.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "testing/one_thread.hpp"

namespace dynamic_icp::mapping {
namespace {

using Eigen::Vector3d;

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

TEST(PlaneMap, TellsTheBendOfASurfaceFromItsNoise) {
  // A floor that waves by `amplitude_m` over the edge of a coarse cell, which no plane follows.
  const auto mean_bend = [](double amplitude_m) {
    std::vector<Vector3d> points = floor_at(0.3, Vector3d::Zero(), 3, 20000);
    for (Vector3d& point : points) {
      point.z() += amplitude_m * std::cos(std::numbers::pi * point.x());
    }
    PlaneMap map({});
    map.add(points, Vector3d::Zero(), kOneThread);
    double sum = 0.0;
    for (double y = -4.5; y < 5.0; y += 2.0) {
      const Patch* patch = map.find(Vector3d(1.0, y, 0.3));
      EXPECT_NE(patch, nullptr);
      EXPECT_GT(patch->plane.points, 100.0) << "of a coarse cell";
      sum += patch->plane.bend / 5.0;
    }
    return sum;
  };
  const double noise = 0.005 * 0.005;
  EXPECT_LT(mean_bend(0.0), 0.02 * noise);
  // Parts of half a metre average the wave over a quarter of its length.
  const double seen = std::sin(std::numbers::pi / 4.0) / (std::numbers::pi / 4.0) * 0.01;
  EXPECT_NEAR(mean_bend(0.01), 0.5 * seen * seen, 0.1 * seen * seen);
}

TEST(PlaneMap, LearnsHowFarRangesErrFromSurfacesThatFaceTheSensor) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-15.0, 15.0);
  const auto scan = [&](double sigma_m) {
    std::vector<Vector3d> points;
    for (int i = 0; i < 20000; ++i) {
      // A wall ahead, some patches of it rough, and the ground at a grazing angle.
      const Vector3d on_wall(20.9, uniform(random), std::abs(uniform(random)));
      const double rough_m = std::sin(0.7 * on_wall.y()) > 0.5 ? 0.05 * normal(random) : 0.0;
      points.push_back(on_wall + (sigma_m * normal(random) + rough_m) * on_wall.normalized());
      const Vector3d on_ground(15.0 + 0.3 * uniform(random), uniform(random), -2.0);
      points.push_back(on_ground + sigma_m * normal(random) * on_ground.normalized());
    }
    return points;
  };
  PlaneMap map({});
  EXPECT_EQ(map.range_sigma_m(), 0.0);
  for (int k = 0; k < 3; ++k) {
    map.add(scan(0.03), Vector3d::Zero(), kOneThread);
  }
  EXPECT_NEAR(map.range_sigma_m(), 0.03, 0.003);
  map.clear();
  EXPECT_NEAR(map.range_sigma_m(), 0.03, 0.003) << "the sensor stays the same";
}

/// The definition, point by point: the coarsest cell around a place whose points lie in a plane. Points fade from one
/// scan with points in the cell to the next; what no scan meets for twice the memory is forgotten.
std::optional<Plane> plane_by_definition(const std::vector<std::vector<Vector3d>>& scans, const Vector3d& place,
                                         const PlaneMapConfig& config) {
  for (int level = config.levels - 1; level >= 0; --level) {
    const double edge_m = std::ldexp(config.finest_cell_m, level);
    const auto cell_of = [&](const Vector3d& point) -> Vector3d { return (point / edge_m).array().floor(); };
    const Vector3d centre = edge_m * (cell_of(place) + Vector3d::Constant(0.5));
    Moments moments;
    std::size_t last = 0;
    for (std::size_t k = 0; k < scans.size(); ++k) {
      bool met = false;
      for (const Vector3d& point : scans[k]) {
        if (cell_of(point) != cell_of(place)) {
          continue;
        }
        const auto age = static_cast<double>(k - last);
        if (!std::exchange(met, true)) {
          moments.scale(age > 2.0 * config.memory_scans ? 0.0 : std::exp(-age / config.memory_scans));
          last = k;
        }
        moments.add(point - centre);
      }
    }
    const bool is_old = static_cast<double>(scans.size() - 1 - last) > 2.0 * config.memory_scans;
    const std::optional<Plane> plane = fit_plane(moments, centre, edge_m, config.plane);
    if (is_old || moments.weight == 0.0 || plane) {
      return is_old ? std::nullopt : plane;
    }
  }
  return std::nullopt;
}

TEST(PlaneMap, IsWhatItsDefinitionSays) {
  // A floor on which boxes come and go: planes turn into heaps, their parts are asked for, and they become planes
  // again.
  PlaneMapConfig config;
  config.memory_scans = 3.0;
  PlaneMap map(config);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-3.0, 3.0);
  std::normal_distribution<double> noise(0.0, 0.005);
  std::vector<std::vector<Vector3d>> scans;
  int planes = 0;
  int no_planes = 0;
  for (int k = 0; k < 12; ++k) {
    std::vector<Vector3d>& scan = scans.emplace_back();
    const bool has_box = k % 4 == 1;
    for (int i = 0; i < 1500; ++i) {
      const Vector3d point(uniform(random), uniform(random), 0.2 + noise(random));
      // Some regions are not seen for a while.
      if (k % 3 != 2 || point.x() > 0.0) {
        scan.push_back(point);
      }
      if (has_box && std::abs(point.x()) < 1.2 && std::abs(point.y()) < 1.2) {
        scan.emplace_back(point.x(), point.y(), 0.9 + 0.3 * uniform(random));
      }
    }
    map.add(scan, Vector3d::Zero(), kOneThread);
    for (int i = 0; i < 100; ++i) {
      const Vector3d place(uniform(random), uniform(random), 0.5 * (1.0 + uniform(random)));
      const Patch* patch = map.find(place);
      const std::optional<Plane> expected = plane_by_definition(scans, place, config);
      ASSERT_EQ(patch != nullptr, expected.has_value()) << "scan " << k << " at " << place.transpose();
      if (patch != nullptr) {
        ++planes;
        EXPECT_LT((patch->plane.mean - expected->mean).norm(), 1e-9);
        EXPECT_NEAR(std::abs(patch->plane.normal.dot(expected->normal)), 1.0, 1e-9);
        EXPECT_NEAR(patch->plane.variance / expected->variance, 1.0, 1e-6);
        EXPECT_NEAR(patch->plane.points, expected->points, 1e-9 * expected->points);
      } else {
        ++no_planes;
      }
    }
  }
  EXPECT_GT(planes, 200);
  EXPECT_GT(no_planes, 50);
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

TEST(PlaneMap, HoldsNoMoreThanTheLastScansMet) {
  // Rain around a sensor that stands: every large cell is met again and again, each small one hardly ever.
  PlaneMapConfig config;
  config.memory_scans = 5.0;
  PlaneMap map(config);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> uniform(-15.0, 15.0);
  constexpr std::size_t kDrops = 500;
  std::size_t after_fifty = 0;
  for (int k = 0; k < 200; ++k) {
    std::vector<Vector3d> drops;
    for (std::size_t i = 0; i < kDrops; ++i) {
      drops.emplace_back(uniform(random), uniform(random), 0.2 * uniform(random));
    }
    map.add(drops, Vector3d::Zero(), kOneThread);
    after_fifty = k == 50 ? map.cell_count() : after_fifty;
  }
  EXPECT_LT(map.cell_count(), 3 * kDrops * (10 + 16)) << "three levels, twice the memory, and what waits for its turn";
  EXPECT_LT(static_cast<double>(map.cell_count()), 1.1 * static_cast<double>(after_fifty));
}

TEST(PlaneMap, MayNeverForget) {
  PlaneMapConfig config;
  config.memory_scans = std::numeric_limits<double>::infinity();
  PlaneMap map(config);
  map.add(floor_at(0.3, Vector3d::Zero(), 1), Vector3d::Zero(), kOneThread);
  map.add({}, Vector3d::Zero(), kOneThread);
  map.add({}, Vector3d::Zero(), kOneThread);
  EXPECT_NE(map.find(Vector3d(1.1, 1.3, 0.3)), nullptr);
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
