// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/doppler_rows.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

namespace dynamic_icp::ego_motion {
namespace {

using Eigen::Vector3d;

Scan random_scan(unsigned seed, std::size_t n, double extent_m) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  RawScan raw;
  for (std::size_t i = 0; i < n; ++i) {
    raw.points.emplace_back(extent_m * Vector3d(uniform(random), uniform(random), uniform(random)));
    raw.doppler.push_back(static_cast<double>(i));  // distinguishes the rows
    raw.times.push_back(0.05 + 0.05 * uniform(random));
  }
  return Scan::from_raw(raw);
}

TEST(DopplerRows, OfNothingAreNone) {
  const DopplerRows rows = sort_into_cells(Scan{}, 2.0, Workers(1));
  EXPECT_EQ(rows.size(), 0u);
  EXPECT_EQ(rows.cells(), 0u);
  EXPECT_FALSE(rows.takes_time);
  EXPECT_EQ(sample(rows, 100).rows.size(), 0u);
}

TEST(DopplerRows, CellsHoldWhatLiesInTheSameCube) {
  const Scan scan = random_scan(1, 5000, 20.0);
  const DopplerRows rows = sort_into_cells(scan, 2.0, Workers(1));
  std::map<std::tuple<double, double, double>, std::vector<double>> expected;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Vector3d cube = (scan.points()[i] / 2.0).array().floor();
    expected[{cube.x(), cube.y(), cube.z()}].push_back(scan.doppler()[i]);
  }
  ASSERT_EQ(rows.cells(), expected.size());
  ASSERT_EQ(rows.size(), scan.size());
  for (std::size_t c = 0; c < rows.cells(); ++c) {
    const auto i = static_cast<std::size_t>(rows.s[rows.first[c]]);
    const Vector3d cube = (scan.points()[i] / 2.0).array().floor();
    const std::vector<double> found(rows.s.begin() + rows.first[c], rows.s.begin() + rows.first[c + 1]);
    EXPECT_EQ(found, (expected[{cube.x(), cube.y(), cube.z()}]));
    EXPECT_NEAR(rows.range[c], scan.points()[i].norm(), 1e-12);
  }
}

TEST(DopplerRows, KeepEachMeasurementWhole) {
  const Scan scan = random_scan(2, 1000, 30.0);
  const DopplerRows rows = sort_into_cells(scan, 2.0, Workers(1));
  EXPECT_TRUE(rows.takes_time);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const auto i = static_cast<std::size_t>(rows.s[row]);
    EXPECT_EQ(rows.u(row), scan.directions()[i]);
    EXPECT_NEAR(rows.dt[row] + rows.reference_time_s, scan.times()[i], 1e-15);
    EXPECT_LE(std::abs(rows.dt[row]), 0.5 * rows.duration_s + 1e-12);
  }
}

TEST(DopplerRows, SmallRoomsGetSmallCells) {
  EXPECT_GE(sort_into_cells(random_scan(3, 4000, 1.5), 2.0, Workers(1)).cells(), 300u);
  // But a handful of points at one place stays a handful.
  RawScan raw;
  raw.points.assign(50, Vector3d(1.0, 2.0, 0.5));
  raw.doppler.assign(50, 0.0);
  EXPECT_EQ(sort_into_cells(Scan::from_raw(raw), 2.0, Workers(1)).cells(), 1u);
}

TEST(DopplerRows, PointsAtAnyDistanceHaveACell) {
  RawScan raw;
  raw.points = {{1e5, 0, 0}, {-1e5, 1, 0}, {0, 0, 1e-9}};
  raw.doppler = {1, 2, 3};
  // Ten million cells away, where only 2^20 have a key of their own.
  const DopplerRows rows = sort_into_cells(Scan::from_raw(raw), 0.01, Workers(1));
  EXPECT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows.sectors, 3u);
}

TEST(ConsensusSet, HasOneVotePerCellAndOneMorePerSectorForTheFarthest) {
  // A near wall of many points and a far one above it, in the same sectors only where they overlap in direction.
  const Scan scan = random_scan(4, 3000, 40.0);
  const DopplerRows rows = sort_into_cells(scan, 2.0, Workers(1));
  const ConsensusSet consensus_set = sample(rows, rows.cells());
  ASSERT_EQ(consensus_set.rows.size(), rows.cells());
  EXPECT_NEAR(std::accumulate(consensus_set.weights.begin(), consensus_set.weights.end(), 0.0), 1.0, 1e-12);
  const double cell_vote = 0.5 / static_cast<double>(rows.cells());
  const double sector_vote = 0.5 / static_cast<double>(rows.sectors);
  std::map<std::uint32_t, double> farthest;
  for (std::size_t c = 0; c < rows.cells(); ++c) {
    farthest[rows.sector[c]] = std::max(farthest[rows.sector[c]], rows.range[c]);
  }
  for (std::size_t c = 0; c < rows.cells(); ++c) {
    const bool outermost = rows.range[c] == farthest[rows.sector[c]];
    EXPECT_NEAR(consensus_set.weights[c], cell_vote + (outermost ? sector_vote : 0.0), 1e-15);
  }
}

TEST(ConsensusSet, WhatCarriesTheSceneHasAThirdOfAllVotes) {
  DopplerRows rows = sort_into_cells(random_scan(4, 3000, 40.0), 2.0, Workers(1));
  rows.on_support.assign(rows.cells(), 0);
  for (std::size_t cell = 0; cell < rows.cells(); cell += 10) {
    rows.on_support[cell] = 1;
  }
  const ConsensusSet with = sample(rows, rows.cells());
  rows.on_support.clear();
  const ConsensusSet without = sample(rows, rows.cells());
  const auto carriers = static_cast<double>((rows.cells() + 9) / 10);
  for (std::size_t cell = 0; cell < rows.cells(); ++cell) {
    EXPECT_NEAR(with.weights[cell], 2.0 / 3.0 * without.weights[cell] + (cell % 10 == 0 ? 1.0 / (3.0 * carriers) : 0.0),
                1e-15);
  }
}

TEST(ConsensusSet, IsNoLargerThanAllowedAndTakesCellsEvenly) {
  const DopplerRows rows = sort_into_cells(random_scan(5, 5000, 40.0), 2.0, Workers(1));
  ASSERT_GT(rows.cells(), 1000u);
  const ConsensusSet consensus_set = sample(rows, 500);
  EXPECT_EQ(consensus_set.rows.size(), 500u);
  EXPECT_EQ(consensus_set.rows.cells(), 500u);
  EXPECT_NEAR(std::accumulate(consensus_set.weights.begin(), consensus_set.weights.end(), 0.0), 1.0, 1e-12);
}

TEST(WithoutRows, LeavesOutCellsOfWhichMoreThanHalfIsFlagged) {
  const Scan scan = random_scan(7, 3000, 10.0);
  spatial::CellOrder order;
  DopplerRows rows;
  sort_into_cells(scan, 4.0, Workers(1), order, rows);
  rows.on_support.assign(rows.cells(), 0);
  rows.on_support.back() = 1;
  // All of the points on one side, and a few of the others.
  std::vector<std::uint8_t> flags(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    flags[i] = scan.points()[i].x() < 0.0 || i % 5 == 0 ? 1 : 0;
  }
  DopplerRows kept = rows;  // memory of something else
  without_rows(rows, order, flags, kept);
  std::vector<double> expected;
  for (std::size_t c = 0; c < rows.cells(); ++c) {
    const auto begin = rows.s.begin() + rows.first[c];
    const auto end = rows.s.begin() + rows.first[c + 1];
    const auto flagged = std::count_if(begin, end, [&](double s) { return flags[static_cast<std::size_t>(s)] != 0; });
    if (2 * flagged <= end - begin) {
      expected.insert(expected.end(), begin, end);
    }
  }
  EXPECT_EQ(kept.s, expected);
  ASSERT_GT(kept.size(), 0u);
  ASSERT_EQ(kept.first.size(), kept.cells() + 1);
  ASSERT_EQ(kept.on_support.size(), kept.cells());
  for (std::size_t c = 0; c < kept.cells(); ++c) {
    const auto i = static_cast<std::size_t>(kept.s[kept.first[c]]);
    EXPECT_NEAR(kept.range[c], scan.points()[i].norm(), 1e-12);
    EXPECT_LT(kept.sector[c], kept.sectors);
  }
  EXPECT_LT(kept.cells(), rows.cells());
}

TEST(SortIntoCells, UsesItsMemoryAgain) {
  spatial::CellOrder order;
  DopplerRows reused;
  for (const Scan& scan : {random_scan(6, 8000, 60.0), Scan{}, random_scan(7, 300, 5.0)}) {
    sort_into_cells(scan, 2.0, Workers(2), order, reused);
    const DopplerRows fresh = sort_into_cells(scan, 2.0, Workers(1));
    EXPECT_EQ(reused.first, fresh.first);
    EXPECT_EQ(reused.s, fresh.s);
    EXPECT_EQ(reused.ux, fresh.ux);
    EXPECT_EQ(reused.dt, fresh.dt);
    EXPECT_EQ(reused.sector, fresh.sector);
    EXPECT_EQ(reused.range, fresh.range);
    EXPECT_EQ(reused.sectors, fresh.sectors);
    EXPECT_EQ(reused.takes_time, fresh.takes_time);
  }
}

}  // namespace
}  // namespace dynamic_icp::ego_motion
