// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/moving_cells.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

const Workers kWorkers(2);

Scan scan_of(const std::vector<Vector3d>& points) {
  RawScan raw;
  raw.points = points;
  raw.doppler.assign(points.size(), 0.0);
  return Scan::from_raw(raw);
}

MovingCell cell(const Vector3d& centroid, double radial) {
  MovingCell result;
  result.centroid = centroid;
  result.radial_mps = radial;
  return result;
}

MovingCells gathered(const Scan& scan, std::span<const double> radial, std::span<const std::uint8_t> is_moving,
                     const GroupingConfig& config, const Workers& workers) {
  MovingCells cells;
  gather_cells(scan, radial, is_moving, config, workers, cells);
  return cells;
}

std::vector<std::uint32_t> grouped(std::span<const MovingCell> cells, const GroupingConfig& config) {
  GroupingMemory memory;
  std::vector<std::uint32_t> groups{7, 7};
  group_cells(cells, config, memory, groups);
  return groups;
}

TEST(MovingCells, NothingMovesNothingIsGathered) {
  EXPECT_TRUE(gathered(Scan{}, {}, {}, {}, kWorkers).cells.empty());
  const Scan scan = scan_of({{5, 0, 0}});
  EXPECT_TRUE(gathered(scan, std::vector<double>{1.0}, std::vector<std::uint8_t>{0}, {}, kWorkers).cells.empty());
  EXPECT_TRUE(grouped({}, {}).empty());
}

TEST(MovingCells, HoldMeansAndRowsOfTheMovingPoints) {
  const Scan scan = scan_of({{5.1, 0.1, 0.1}, {9.1, 0.1, 0.1}, {5.3, 0.3, 0.3}, {5.2, 0.2, 0.2}});
  const std::vector<double> radial = {1.0, 7.0, 3.0, 50.0};
  const MovingCells moving =
      gathered(scan, radial, std::vector<std::uint8_t>{1, 1, 1, 0}, {.cell_size_m = 1.0}, kWorkers);
  ASSERT_EQ(moving.cells.size(), 2u);
  EXPECT_TRUE(moving.cells[0].centroid.isApprox(Vector3d(5.2, 0.2, 0.2), 1e-12));
  EXPECT_EQ(moving.cells[0].radial_mps, 2.0);
  EXPECT_EQ(moving.cells[0].count, 2u);
  EXPECT_EQ(moving.rows, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(moving.order.cell, (std::vector<std::uint32_t>{0, 1, 0}));
}

TEST(MovingCells, OneWrongDopplerMovesNoCell) {
  const Scan scan = scan_of({{5.1, 0.1, 0.1}, {5.3, 0.3, 0.3}, {5.2, 0.2, 0.2}, {5.2, 0.1, 0.2}});
  const std::vector<double> radial = {2.1, -28.0, 2.2, 2.3};
  const MovingCells moving =
      gathered(scan, radial, std::vector<std::uint8_t>{1, 1, 1, 1}, {.cell_size_m = 1.0}, kWorkers);
  ASSERT_EQ(moving.cells.size(), 1u);
  EXPECT_DOUBLE_EQ(moving.cells[0].radial_mps, 2.15);
}

TEST(MovingCells, CellsFloorBelowZero) {
  const Scan scan = scan_of({{-0.1, 5, 0.1}, {0.1, 5, 0.1}});
  EXPECT_EQ(gathered(scan, std::vector<double>{1, 1}, std::vector<std::uint8_t>{1, 1}, {}, kWorkers).cells.size(), 2u);
}

TEST(MovingCells, NeighboursWithOneVelocityAreOneGroup) {
  const std::vector<MovingCell> cells = {cell({10, 0, 0}, 5), cell({20, 0, 0}, 5), cell({10.5, 0, 0}, 5.2)};
  EXPECT_EQ(grouped(cells, {}), (std::vector<std::uint32_t>{0, 1, 0}));
}

TEST(MovingCells, AJumpOfTheVelocityParts) {
  const std::vector<MovingCell> cells = {cell({10, 0, 0}, 5), cell({10.5, 0, 0}, 8)};
  EXPECT_EQ(grouped(cells, {}), (std::vector<std::uint32_t>{0, 1}));
}

TEST(MovingCells, TheGapWhereTheVelocityPassesZeroIsBridged) {
  EXPECT_EQ(grouped(std::vector<MovingCell>{cell({30, 1, 0}, 0.4), cell({30, -1, 0}, -0.4)}, {}),
            (std::vector<std::uint32_t>{0, 0}));
  EXPECT_EQ(grouped(std::vector<MovingCell>{cell({30, 1, 0}, 0.4), cell({30, -1, 0}, 0.4)}, {}),
            (std::vector<std::uint32_t>{0, 1}))
      << "no sign changes: nothing is missing between them";
  EXPECT_EQ(grouped(std::vector<MovingCell>{cell({30, 1, 0}, 4.0), cell({30, -1, 0}, -4.0)}, {}),
            (std::vector<std::uint32_t>{0, 1}))
      << "two that pass each other";
}

/// The smallest number of a cell that each one is joined to, by all pairs.
std::vector<std::uint32_t> connected(const std::vector<MovingCell>& cells, const GroupingConfig& config) {
  std::vector<std::uint32_t> expected(cells.size());
  for (std::uint32_t i = 0; i < expected.size(); ++i) {
    expected[i] = i;
  }
  // Smallest labels spread over all pairs until nothing changes.
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      for (std::size_t k = 0; k < cells.size(); ++k) {
        const double range = std::min(cells[i].centroid.norm(), cells[k].centroid.norm());
        const double distance = (cells[i].centroid - cells[k].centroid).norm();
        const double ra = cells[i].radial_mps;
        const double rb = cells[k].radial_mps;
        const bool bridge = ra * rb < 0.0 && std::max(std::abs(ra), std::abs(rb)) <= config.bridge_velocity_mps;
        const bool together =
            distance <= (bridge ? config.bridge_m : config.link_distance_m + config.link_growth * range) &&
            std::abs(cells[i].radial_mps - cells[k].radial_mps) <=
                config.link_velocity_mps + config.link_shear_rps * distance;
        if (together && expected[k] > expected[i]) {
          expected[k] = expected[i];
          changed = true;
        }
      }
    }
  }
  return expected;
}

TEST(MovingCells, GroupsAreTheConnectedOnesOfAllPairs) {
  // Few in a cube; many, with all velocities; and bodies whose cubes are full of one velocity, side by side.
  for (const double width_m : {10.0, 2.0, 4.0}) {
    std::vector<MovingCell> cells;
    for (std::uint64_t i = 0; i < 400; ++i) {
      const RandomSource one = RandomSource(23).fork(i);
      const Vector3d at(one.uniform(0, 5, 5 + 3.5 * width_m), one.uniform(1, -width_m, width_m), one.uniform(2, 0, 2));
      const double of_body = std::floor(0.4 * at.x()) + (at.y() > 0.1 ? 4.0 : 0.0);
      cells.push_back(cell(at, width_m == 4.0 ? of_body + one.uniform(3, -0.2, 0.2) : one.uniform(3, -1.5, 1.5)));
    }
    const GroupingConfig config;
    const std::vector<std::uint32_t> expected = connected(cells, config);
    const std::vector<std::uint32_t> groups = grouped(cells, config);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        ASSERT_EQ(groups[i] == groups[k], expected[i] == expected[k]) << i << " and " << k << ", " << width_m;
      }
    }
    EXPECT_GT(std::ranges::max(groups), 2u);
  }
}

TEST(MovingCells, GroupsDoNotDependOnTheOrderOfTheCells) {
  // Cells of all speeds, so that bridges count, in a wall across the x axis.
  const RandomSource random(29);
  std::vector<MovingCell> cells;
  for (std::uint64_t i = 0; i < 600; ++i) {
    const RandomSource one = random.fork(i);
    cells.push_back(cell({30.0, one.uniform(0, -40, 40), one.uniform(1, -2, 12)}, one.uniform(2, -1.5, 1.5)));
  }
  const std::vector<MovingCell> reversed(cells.rbegin(), cells.rend());
  const std::vector<std::uint32_t> groups = grouped(cells, {});
  const std::vector<std::uint32_t> of_reversed = grouped(reversed, {});
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      ASSERT_EQ(groups[i] == groups[k], of_reversed[cells.size() - 1 - i] == of_reversed[cells.size() - 1 - k]);
    }
  }
  EXPECT_GT(*std::max_element(groups.begin(), groups.end()), 10u);
}

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
    moving.order.cell.push_back(i);
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

CellGroups groups_of(const MovingCells& moving, std::span<const std::uint32_t> cells, int min_points) {
  GroupingMemory memory;
  CellGroups groups;
  for (int i = 0; i < 2; ++i) {  // what was there before does not count
    vehicle_groups(moving, cells, 2.6, min_points, {}, memory, groups);
  }
  return groups;
}

CellGroups groups_of(const MovingCells& moving, int min_points) {
  std::vector<std::uint32_t> all(moving.cells.size());
  std::iota(all.begin(), all.end(), 0u);
  return groups_of(moving, all, min_points);
}

TEST(CellGroups, OfNothingThereAreNone) { EXPECT_EQ(groups_of(MovingCells(), 1).size(), 0u); }

TEST(CellGroups, AVehicleIsOne) {
  std::vector<Vector3d> places;
  add_vehicle(places, 40.0, 0.0);
  const CellGroups groups = groups_of(cells_at(places), 10);
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(groups.cells_of(0).size(), places.size());
  EXPECT_EQ(groups.rows_of(0).size(), places.size());
  EXPECT_EQ(groups.rows_of(0).front(), 0u);
  EXPECT_EQ(groups.rows_of(0).back(), 10 * (places.size() - 1));
}

TEST(CellGroups, TwoAbreastThatAreLinkedAreParted) {
  // Links reach 0.7 + 0.008 * 40 = 1.02 m there, and the gap is 0.95 m.
  std::vector<Vector3d> places;
  add_vehicle(places, 40.0, 0.0);
  add_vehicle(places, 40.0, 2.95);
  EXPECT_EQ(groups_of(cells_at(places), 10).size(), 2u);
}

TEST(CellGroups, TwoAbreastThatOnlyABridgeLinksAreParted) {
  // Ahead of the sensor their radial velocities are small and of both signs, as in one body that crosses.
  std::vector<Vector3d> places;
  add_vehicle(places, 20.0, -1.75);
  add_vehicle(places, 20.0, 1.75);
  MovingCells moving = cells_at(places);
  for (MovingCell& one : moving.cells) {
    one.radial_mps = one.centroid.y() > 0.0 ? 0.4 : -0.4;
  }
  ASSERT_EQ(grouped(moving.cells, {}), std::vector<std::uint32_t>(places.size(), 0)) << "a bridge";
  EXPECT_EQ(groups_of(moving, 10).size(), 2u);
}

TEST(CellGroups, TooFewPointsAreNoObject) {
  EXPECT_EQ(groups_of(cells_at({{20, 0, 0}, {20.5, 0, 0}}), 3).size(), 0u);
  EXPECT_EQ(groups_of(cells_at({{20, 0, 0}, {20.5, 0, 0}}), 2).size(), 1u);
}

TEST(CellGroups, OnlyTheChosenCellsAreGrouped) {
  const MovingCells moving = cells_at({{20, 0, 0}, {20.5, 0, 0}, {21, 0, 0}});
  const CellGroups groups = groups_of(moving, std::vector<std::uint32_t>{0, 2}, 1);
  ASSERT_EQ(groups.size(), 2u) << "without the middle one they are too far apart";
  ASSERT_EQ(groups.rows_of(1).size(), 1u);
  EXPECT_EQ(groups.rows_of(1).front(), 20u);
}

}  // namespace
}  // namespace dynamic_icp::tracking
