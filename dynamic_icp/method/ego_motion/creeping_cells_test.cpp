// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/creeping_cells.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace dynamic_icp::ego_motion {
namespace {

using Eigen::Vector3d;

constexpr double kNoise_mps = 0.1;
constexpr double kSigmas = 4.0;

/// The sensor drives and accelerates; every direction has a wall, and some have something in front of it.
struct Scene {
  EgoVelocity ego;
  DopplerRows rows;
  std::vector<std::size_t> near_cells;
  std::mt19937 random{7};

  Scene() {
    ego.velocity_sensor << 8.0, 0.5, -0.1;
    ego.acceleration_sensor << 1.0, -0.5, 0.0;
    ego.bias_mps = 0.3;
    rows.first.push_back(0);
  }

  /// Points in one direction, whose Doppler is that of static ones and `off_mps` more.
  void add_cell(std::uint32_t sector, double range_m, std::size_t points, double off_mps) {
    std::normal_distribution<double> normal;
    for (std::size_t k = 0; k < points; ++k) {
      const double azimuth = 2.0 * std::numbers::pi * sector / 100.0 + 0.002 * normal(random);
      const Vector3d u(std::cos(azimuth), std::sin(azimuth), 0.0);
      const double dt = 0.05 * std::sin(static_cast<double>(k + sector));
      rows.ux.push_back(u.x());
      rows.uy.push_back(u.y());
      rows.uz.push_back(u.z());
      rows.dt.push_back(dt);
      rows.s.push_back(-u.dot(ego.velocity_sensor + dt * ego.acceleration_sensor) + ego.bias_mps + off_mps +
                       kNoise_mps * normal(random));
    }
    rows.first.push_back(static_cast<std::uint32_t>(rows.s.size()));
    rows.sector.push_back(sector);
    rows.range.push_back(range_m);
  }

  /// A hundred walls that err by `error_mps` times a standard normal number each, and things in front of every fifth.
  void fill(double error_mps, double creep_mps) {
    std::normal_distribution<double> normal;
    for (std::uint32_t sector = 0; sector < 100; ++sector) {
      if (sector % 5 == 0) {
        near_cells.push_back(rows.cells());
        add_cell(sector, 10.0, 40, creep_mps + error_mps * normal(random));
      }
      add_cell(sector, 60.0, 40, error_mps * normal(random));
    }
  }
};

std::size_t count(const std::vector<std::uint8_t>& creeps, const std::vector<std::size_t>& cells) {
  std::size_t result = 0;
  for (const std::size_t cell : cells) {
    result += creeps[cell];
  }
  return result;
}

std::size_t count(const std::vector<std::uint8_t>& creeps) {
  std::size_t result = 0;
  for (const std::uint8_t creep : creeps) {
    result += creep;
  }
  return result;
}

TEST(CreepingCells, OfNothingAreNone) {
  DopplerRows rows;
  rows.first.push_back(0);
  EXPECT_TRUE(creeping_cells(rows, {}, kNoise_mps, kSigmas).empty());
}

TEST(CreepingCells, AStaticSceneHasNone) {
  Scene scene;
  scene.fill(0.0, 0.0);
  const std::vector<std::uint8_t> creeps = creeping_cells(scene.rows, scene.ego, kNoise_mps, kSigmas);
  EXPECT_EQ(creeps.size(), scene.rows.cells());
  EXPECT_EQ(count(creeps), 0U);
}

TEST(CreepingCells, AreThoseWhoseMeanMovesThoughNoPointDoes) {
  // 0.3 m/s is three standard deviations of a point, but sixteen of the mean of 40 and the 0.015 m/s of surfaces.
  for (const double creep_mps : {0.3, -0.3}) {
    Scene scene;
    scene.fill(0.0, creep_mps);
    const std::vector<std::uint8_t> creeps = creeping_cells(scene.rows, scene.ego, kNoise_mps, kSigmas);
    EXPECT_EQ(count(creeps, scene.near_cells), scene.near_cells.size());
    EXPECT_EQ(count(creeps), scene.near_cells.size()) << "and no other";
  }
}

TEST(CreepingCells, ASensorThatErrsShowsLess) {
  // The far scene is off by 0.15 m/s itself: what creeps at 0.3 m/s cannot be told, at 1.5 m/s it can.
  Scene slow;
  slow.fill(0.15, 0.3);
  EXPECT_LE(count(creeping_cells(slow.rows, slow.ego, kNoise_mps, kSigmas)), 1U);
  Scene fast;
  fast.fill(0.15, 1.5);
  const std::vector<std::uint8_t> creeps = creeping_cells(fast.rows, fast.ego, kNoise_mps, kSigmas);
  EXPECT_EQ(count(creeps, fast.near_cells), fast.near_cells.size());
  EXPECT_LE(count(creeps), fast.near_cells.size() + 1);
}

TEST(CreepingCells, FewPointsProveLess) {
  // 0.3 m/s of one point is three of its standard deviations, less than four.
  Scene scene;
  scene.fill(0.0, 0.0);
  const std::size_t alone = scene.rows.cells();
  scene.add_cell(3, 10.0, 1, 0.0);
  scene.rows.s.back() = -scene.rows.u(scene.rows.size() - 1)
                             .dot(scene.ego.velocity_sensor + scene.rows.dt.back() * scene.ego.acceleration_sensor) +
                        scene.ego.bias_mps + 0.3;
  EXPECT_EQ(creeping_cells(scene.rows, scene.ego, kNoise_mps, kSigmas)[alone], 0);
  scene.rows.s.back() += 0.3;
  EXPECT_EQ(creeping_cells(scene.rows, scene.ego, kNoise_mps, kSigmas)[alone], 1);
}

TEST(CreepingCells, ManyInFrontOfTheSceneDoNotPassForIt) {
  // Two thirds of all cells creep, but behind each of them there is a wall.
  Scene scene;
  for (std::uint32_t sector = 0; sector < 50; ++sector) {
    scene.add_cell(sector, 10.0, 40, 0.4);
    scene.add_cell(sector, 60.0, 40, 0.0);
    scene.add_cell(sector, 20.0, 40, 0.4);
  }
  const std::vector<std::uint8_t> creeps = creeping_cells(scene.rows, scene.ego, kNoise_mps, kSigmas);
  for (std::size_t cell = 0; cell < creeps.size(); ++cell) {
    EXPECT_EQ(creeps[cell], cell % 3 == 1 ? 0 : 1);
  }
}

}  // namespace
}  // namespace dynamic_icp::ego_motion
