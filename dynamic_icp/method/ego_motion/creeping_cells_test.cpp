// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/creeping_cells.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/quantile.hpp"
#include "dynamic_icp/method/spatial/cell_key.hpp"

namespace dynamic_icp::ego_motion {
namespace {

using Eigen::Vector3d;

constexpr double kNoise_mps = 0.1;
constexpr double kSigmas = 4.0;
constexpr double kMoving_mps = 2.0;

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
  EXPECT_TRUE(creeping_cells(rows, {}, kNoise_mps, kMoving_mps, kSigmas).empty());
}

TEST(CreepingCells, AStaticSceneHasNone) {
  Scene scene;
  scene.fill(0.0, 0.0);
  const std::vector<std::uint8_t> creeps = creeping_cells(scene.rows, scene.ego, kNoise_mps, kMoving_mps, kSigmas);
  EXPECT_EQ(creeps.size(), scene.rows.cells());
  EXPECT_EQ(count(creeps), 0U);
}

TEST(CreepingCells, AreThoseWhoseMeanMovesThoughNoPointDoes) {
  // 0.3 m/s is three standard deviations of a point, but sixteen of the mean of 40 and the 0.015 m/s of surfaces.
  for (const double creep_mps : {0.3, -0.3}) {
    Scene scene;
    scene.fill(0.0, creep_mps);
    const std::vector<std::uint8_t> creeps = creeping_cells(scene.rows, scene.ego, kNoise_mps, kMoving_mps, kSigmas);
    EXPECT_EQ(count(creeps, scene.near_cells), scene.near_cells.size());
    EXPECT_EQ(count(creeps), scene.near_cells.size()) << "and no other";
  }
}

TEST(CreepingCells, ASensorThatErrsShowsLess) {
  // The far scene is off by 0.15 m/s itself: what creeps at 0.3 m/s cannot be told, at 1.5 m/s it can.
  Scene slow;
  slow.fill(0.15, 0.3);
  EXPECT_LE(count(creeping_cells(slow.rows, slow.ego, kNoise_mps, kMoving_mps, kSigmas)), 1U);
  Scene fast;
  fast.fill(0.15, 1.5);
  const std::vector<std::uint8_t> creeps = creeping_cells(fast.rows, fast.ego, kNoise_mps, kMoving_mps, kSigmas);
  EXPECT_EQ(count(creeps, fast.near_cells), fast.near_cells.size());
  EXPECT_LE(count(creeps), fast.near_cells.size() + 1);
}

TEST(CreepingCells, WhatMovesOrIsFalseTellsNothingOfOtherPoints) {
  Scene scene;
  scene.fill(0.0, 0.0);
  for (std::size_t cell = 0; cell < scene.rows.cells(); ++cell) {
    scene.rows.s[scene.rows.first[cell] + cell % 40] += 20.0;  // 0.5 m/s in the mean of 40
  }
  EXPECT_EQ(count(creeping_cells(scene.rows, scene.ego, kNoise_mps, kMoving_mps, kSigmas)), 0U);
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
  EXPECT_EQ(creeping_cells(scene.rows, scene.ego, kNoise_mps, kMoving_mps, kSigmas)[alone], 0);
  scene.rows.s.back() += 0.3;
  EXPECT_EQ(creeping_cells(scene.rows, scene.ego, kNoise_mps, kMoving_mps, kSigmas)[alone], 1);
}

TEST(CreepingCells, ManyInFrontOfTheSceneDoNotPassForIt) {
  // Two thirds of all cells creep, but behind each of them there is a wall.
  Scene scene;
  for (std::uint32_t sector = 0; sector < 50; ++sector) {
    scene.add_cell(sector, 10.0, 40, 0.4);
    scene.add_cell(sector, 60.0, 40, 0.0);
    scene.add_cell(sector, 20.0, 40, 0.4);
  }
  const std::vector<std::uint8_t> creeps = creeping_cells(scene.rows, scene.ego, kNoise_mps, kMoving_mps, kSigmas);
  for (std::size_t cell = 0; cell < creeps.size(); ++cell) {
    EXPECT_EQ(creeps[cell], cell % 3 == 1 ? 0 : 1);
  }
}

TEST(CreepingCells, WhereTheSupportIsKnownFarThingsNeedNotStand) {
  // A queue: whatever is farthest in a direction creeps at 0.4 m/s; the road before it stands.
  Scene scene;
  for (std::uint32_t sector = 0; sector < 60; ++sector) {
    scene.add_cell(sector, 12.0, 40, 0.0);
    scene.add_cell(sector, 20.0, 40, 0.4);
  }
  EXPECT_EQ(count(creeping_cells(scene.rows, scene.ego, kNoise_mps, kMoving_mps, kSigmas)), 0U)
      << "as if the sensor erred";
  for (std::size_t cell = 0; cell < scene.rows.cells(); ++cell) {
    scene.rows.on_support.push_back(cell % 2 == 0 ? 1 : 0);
  }
  const std::vector<std::uint8_t> creeps = creeping_cells(scene.rows, scene.ego, kNoise_mps, kMoving_mps, kSigmas);
  for (std::size_t cell = 0; cell < creeps.size(); ++cell) {
    EXPECT_EQ(creeps[cell], cell % 2) << cell;
  }
}

TEST(CreepingCells, InTrafficWhatIsOffMostLikelyCreeps) {
  // A road that errs by 0.05 m/s, and things above it that are off by 3.7 times as much: errors of the sensor where all
  // else stands, traffic where nearly all else moves.
  for (const bool in_traffic : {false, true}) {
    Scene scene;
    std::vector<std::size_t> slow;
    for (std::uint32_t sector = 0; sector < 100; ++sector) {
      scene.add_cell(sector, 12.0, 400, sector % 2 == 0 ? 0.05 : -0.05);
      scene.rows.on_support.push_back(1);
      if (sector % 20 == 0) {
        slow.push_back(scene.rows.cells());
      }
      scene.add_cell(sector, 20.0, 400, sector % 20 == 0 ? 3.7 * 0.05 * kSigmaPerMad : in_traffic ? 3.0 : 0.0);
      scene.rows.on_support.push_back(0);
    }
    const std::vector<std::uint8_t> creeps = creeping_cells(scene.rows, scene.ego, kNoise_mps, kMoving_mps, kSigmas);
    EXPECT_EQ(count(creeps, slow), in_traffic ? slow.size() : 0U);
    EXPECT_EQ(count(creeps), count(creeps, slow)) << "what moves tells no cell, and the road carries it";
  }
}

TEST(CreepingCells, InACrowdTheSlowerEndOfABodyGoesWithIt) {
  // Bodies of three cells in a row; the last is off by 0.05 m/s, two standard deviations of a cell. Behind them walls.
  Scene crowd;
  const auto add = [&](std::int64_t x, std::int64_t y, double off_mps) {
    const bool is_wall = x >= 100;
    crowd.add_cell(static_cast<std::uint32_t>(crowd.rows.cells() % 60), is_wall ? 60.0 : 20.0, 40, off_mps);
    crowd.rows.key.push_back(spatial::cell_key(x, y, 0));
  };
  constexpr std::int64_t kBodies = 30;
  for (std::int64_t body = 0; body < kBodies; ++body) {
    add(0, 10 * body, 0.4);
    add(1, 10 * body, 0.4);
    add(2, 10 * body, 0.05);
    add(3, 10 * body, -0.05);  // off, but to the other side
    add(8, 10 * body, 0.05);   // off alike, but somewhere else
  }
  const std::size_t bodies = crowd.rows.cells();
  for (std::int64_t k = 0; k < 60; ++k) {
    add(100 + 5 * k, 0, 0.0);
  }
  const std::vector<std::uint8_t> creeps = creeping_cells(crowd.rows, crowd.ego, kNoise_mps, kMoving_mps, kSigmas);
  std::array<std::size_t, 5> of_body{};
  for (std::size_t cell = 0; cell < bodies; ++cell) {
    of_body[cell % 5] += creeps[cell];
  }
  EXPECT_EQ(of_body[0], static_cast<std::size_t>(kBodies));
  EXPECT_EQ(of_body[1], static_cast<std::size_t>(kBodies));
  EXPECT_GT(of_body[2], static_cast<std::size_t>(kBodies) * 3 / 4);
  EXPECT_LE(of_body[3], 1U);
  EXPECT_LE(of_body[4], 1U);
}

}  // namespace
}  // namespace dynamic_icp::ego_motion
