// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/preprocess/voxel_grid.hpp"

#include <array>
#include <cmath>
#include <map>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace dynamic_icp::preprocess {
namespace {

Scan scan_of(const std::vector<Eigen::Vector3d>& points) {
  RawScan raw;
  raw.points = points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    raw.doppler.push_back(static_cast<double>(i));
  }
  return Scan::from_raw(raw);
}

TEST(VoxelGrid, KeepsTheFirstMeasuredPointOfAVoxel) {
  const Scan kept = voxel_grid(scan_of({{0.1, 0.1, 0.1}, {0.9, 0.9, 0.9}, {1.1, 0.1, 0.1}, {0.5, 0.5, 0.5}}), {1.0});
  EXPECT_EQ(kept.records(), (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(kept.points()[0], Eigen::Vector3d(0.1, 0.1, 0.1)) << "as measured, not averaged";
  EXPECT_EQ(kept.doppler(), (std::vector<double>{0.0, 2.0}));
}

TEST(VoxelGrid, FloorsBelowZeroToo) {
  // Truncation would put -0.1 and 0.1 into the same voxel.
  EXPECT_EQ(voxel_grid(scan_of({{-0.1, 0.5, 0.5}, {0.1, 0.5, 0.5}}), {1.0}).size(), 2u);
  EXPECT_EQ(voxel_grid(scan_of({{-0.1, 0.5, 0.5}, {-0.9, 0.5, 0.5}, {-1.0, 0.5, 0.5}}), {1.0}).size(), 1u);
}

TEST(VoxelGrid, EqualsTheDirectDefinition) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-20.0, 20.0);
  std::vector<Eigen::Vector3d> points(5000);
  for (Eigen::Vector3d& point : points) {
    point = {uniform(random), uniform(random), 0.2 * uniform(random)};
  }
  for (const double size : {0.05, 0.3, 1.7, 100.0}) {
    std::map<std::array<long, 3>, std::uint32_t> first;
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      std::array<long, 3> cell{};
      for (int axis = 0; axis < 3; ++axis) {
        cell[static_cast<std::size_t>(axis)] = static_cast<long>(std::floor(points[i][axis] / size));
      }
      if (first.emplace(cell, i).second) {
        expected.push_back(i);
      }
    }
    EXPECT_EQ(voxel_grid(scan_of(points), {size}).records(), expected) << "size " << size;
  }
}

TEST(VoxelGrid, AllPointsInOneVoxelLeaveOne) {
  EXPECT_EQ(voxel_grid(scan_of(std::vector<Eigen::Vector3d>(1000, {5.05, 5.05, 5.05})), {0.3}).size(), 1u);
}

TEST(VoxelGrid, ZeroKeepsEveryPointAndNothingStaysNothing) {
  EXPECT_EQ(voxel_grid(scan_of({{1, 1, 1}, {1, 1, 1}}), {0.0}).size(), 2u);
  EXPECT_TRUE(voxel_grid(Scan{}, {0.3}).empty());
}

TEST(VoxelGrid, RefusesCoordinatesItCannotTellApart) {
  EXPECT_THROW(voxel_grid(scan_of({{9e4, 0, 0}}), {0.05}), std::invalid_argument);
}

}  // namespace
}  // namespace dynamic_icp::preprocess
