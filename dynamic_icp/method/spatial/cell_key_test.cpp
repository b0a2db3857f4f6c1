// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/spatial/cell_key.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace dynamic_icp::spatial {
namespace {

using Cell = Eigen::Matrix<std::int64_t, 3, 1>;

TEST(CellKey, FloorsLikeTheStandardLibrary) {
  for (const double value : {-3.0, -2.5, -1.0, -1e-300, -0.0, 0.0, 0.3, 1.0, 1.999999, 123456.5, -123456.5}) {
    EXPECT_EQ(floor_to_int(value), static_cast<std::int64_t>(std::floor(value))) << value;
  }
}

TEST(CellKey, HoldsTheCoordinates) {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::int64_t> any(-kCellsEachWay, kCellsEachWay - 1);
  for (int i = 0; i < 1000; ++i) {
    const Cell cell(any(random), any(random), any(random));
    const std::uint64_t key = cell_key(cell.x(), cell.y(), cell.z());
    EXPECT_EQ(cell_coordinates(key), cell);
    EXPECT_NE(key, kNoCell);
    const Eigen::Vector3d centre = cell_centre(key, 0.5);
    EXPECT_EQ(cell_key(centre / 0.5), key);
    EXPECT_EQ(clamped_cell_key(centre / 0.5), key);
  }
}

TEST(CellKey, KnowsWhatIsOutOfReach) {
  constexpr double kReach = 1 << 20;
  EXPECT_EQ(cell_key(Eigen::Vector3d(kReach, 0, 0)), kNoCell);
  EXPECT_EQ(cell_key(Eigen::Vector3d(0, -1e300, 0)), kNoCell);
  EXPECT_EQ(cell_key(Eigen::Vector3d(0, 0, std::numeric_limits<double>::quiet_NaN())), kNoCell);
  EXPECT_NE(cell_key(Eigen::Vector3d(kReach - 0.5, 0, 0)), kNoCell);
  EXPECT_EQ(cell_coordinates(clamped_cell_key(Eigen::Vector3d(1e300, -1e300, 0.5))),
            Cell(kCellsEachWay - 1, -kCellsEachWay, 0));
}

}  // namespace
}  // namespace dynamic_icp::spatial
