// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/cell_groups.hpp"

#include <numeric>

#include <gtest/gtest.h>

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

/// One point in each cell, all with one velocity.
MovingCells cells_at(const std::vector<Vector3d>& places) {
  MovingCells moving;
  for (std::uint32_t i = 0; i < places.size(); ++i) {
    MovingCell cell;
    cell.centroid = places[i];
    cell.radial_mps = 5.0;
    cell.count = 1;
    moving.cells.push_back(cell);
    moving.rows.push_back(10 * i);
    moving.cell_of.push_back(i);
  }
  return moving;
}

/// The rear and the two sides of a vehicle, half a metre between cells.
void add_vehicle(std::vector<Vector3d>& places, double x, double y) {
  for (double across = -1.0; across <= 1.0; across += 0.5) {
    places.emplace_back(x, y + across, 0.0);
  }
  for (double along = 0.5; along <= 4.0; along += 0.5) {
    places.emplace_back(x + along, y - 1.0, 0.0);
    places.emplace_back(x + along, y + 1.0, 0.0);
  }
}

std::vector<CellGroup> groups_of(const MovingCells& moving, int min_points) {
  std::vector<std::uint32_t> all(moving.cells.size());
  std::iota(all.begin(), all.end(), 0u);
  return vehicle_groups(moving, all, 2.6, min_points, {});
}

TEST(CellGroups, OfNothingThereAreNone) { EXPECT_TRUE(groups_of({}, 1).empty()); }

TEST(CellGroups, AVehicleIsOne) {
  std::vector<Vector3d> places;
  add_vehicle(places, 40.0, 0.0);
  const std::vector<CellGroup> groups = groups_of(cells_at(places), 10);
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(groups[0].cells.size(), places.size());
  EXPECT_EQ(groups[0].rows.front(), 0u);
  EXPECT_EQ(groups[0].rows.back(), 10 * (places.size() - 1));
}

TEST(CellGroups, TwoAbreastThatAreLinkedAreParted) {
  // Links reach 0.7 + 0.008 * 40 = 1.02 m there, and the gap is 0.95 m.
  std::vector<Vector3d> places;
  add_vehicle(places, 40.0, 0.0);
  add_vehicle(places, 40.0, 2.95);
  EXPECT_EQ(groups_of(cells_at(places), 10).size(), 2u);
}

TEST(CellGroups, TooFewPointsAreNoObject) {
  EXPECT_TRUE(groups_of(cells_at({{20, 0, 0}, {20.5, 0, 0}}), 3).empty());
  EXPECT_EQ(groups_of(cells_at({{20, 0, 0}, {20.5, 0, 0}}), 2).size(), 1u);
}

TEST(CellGroups, OnlyTheChosenCellsAreGrouped) {
  const MovingCells moving = cells_at({{20, 0, 0}, {20.5, 0, 0}, {21, 0, 0}});
  const std::vector<CellGroup> groups = vehicle_groups(moving, std::vector<std::uint32_t>{0, 2}, 2.6, 1, {});
  ASSERT_EQ(groups.size(), 2u) << "without the middle one they are too far apart";
  EXPECT_EQ(groups[1].rows, (std::vector<std::uint32_t>{20}));
}

}  // namespace
}  // namespace dynamic_icp::tracking
