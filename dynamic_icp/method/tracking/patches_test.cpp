// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/patches.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/tracking/sensor_motion.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

/// Columns of points one above the other, up to 60 m away, as a sensor sees them that looks around in 0.1 s.
Scan columns(std::size_t rows, bool has_times) {
  RawScan raw;
  for (std::size_t i = 0; i < rows; ++i) {
    const RandomSource one = RandomSource(6).fork(i);
    const double azimuth = 0.02 * std::floor(static_cast<double>(i) / 50.0);
    const double range = one.uniform(0, 4.0, 60.0);
    raw.points.emplace_back(range * std::cos(azimuth), range * std::sin(azimuth), one.uniform(1, -2.0, 6.0));
    raw.doppler.push_back(0.0);
    if (has_times) {
      raw.times.push_back(0.1 * static_cast<double>(i) / static_cast<double>(rows) - 0.02);
    }
  }
  return Scan::from_raw(raw);
}

TEST(PatchBlock, APatchWithPointsInAPlaceIsFoundWhileTheSensorTurns) {
  const Vector3d turning(0.3, -0.2, 1.0);
  for (const std::size_t rows : {1u, 127u, 130u, 259u, 8192u}) {
    for (const bool has_times : {false, true}) {
      const Scan scan = columns(rows, has_times);
      SensorMotion sensor;  // it does not move: what is sought does
      sensor.angular_velocity_sensor = turning;
      PatchBlock patches;
      patches.bound(scan.points(), scan.times());
      ASSERT_EQ(patches.count(), (rows + PatchBlock::kRows - 1) / PatchBlock::kRows);
      std::size_t found = 0;
      std::size_t needed = 0;
      for (std::uint64_t k = 0; k < 200; ++k) {
        const RandomSource one = RandomSource(7).fork(k);
        const Vector3d at = scan.points()[static_cast<std::size_t>(one.uniform(0, 0.0, 1.0) * double(rows - 1))];
        SoughtPlace place;
        place.centre = at;
        place.drift = 20.0 * Vector3d(one.uniform(1, -1, 1), one.uniform(2, -1, 1), 0.0);
        place.half_height_m = 0.8;
        place.turn_rps = turning.norm();
        const double yaw = one.uniform(3, -3.0, 3.0);
        const Eigen::Vector2d ahead(std::cos(yaw), std::sin(yaw));
        const bool is_box = k % 2 == 0;
        if (is_box) {
          place.half_length = 3.0 * ahead;
          place.half_width = 1.0 * Eigen::Vector2d(-ahead.y(), ahead.x());
        } else {
          place.reach_m = 2.0;
        }
        PatchBlock::Flags may_hold{};
        patches.find(place, may_hold);
        std::vector<std::uint8_t> holds(patches.count(), 0);
        for (std::size_t i = 0; i < rows; ++i) {
          const double time = has_times ? scan.times()[i] : 0.0;
          const Vector3d apart = sensor.point_world(scan.points()[i], time) - place.centre - time * place.drift;
          const Eigen::Vector2d level = apart.head<2>();
          const bool is_inside = is_box ? std::abs(level.dot(ahead)) <= 3.0 &&
                                              std::abs(level.x() * ahead.y() - level.y() * ahead.x()) <= 1.0
                                        : level.norm() <= place.reach_m;
          const bool is_there = is_inside && std::abs(apart.z()) <= place.half_height_m;
          holds[i / PatchBlock::kRows] |= is_there ? 1 : 0;
        }
        for (std::size_t patch = 0; patch < holds.size(); ++patch) {
          EXPECT_LE(holds[patch], may_hold[patch]) << patch << " of " << rows;
          needed += holds[patch];
          found += may_hold[patch];
        }
      }
      EXPECT_GE(needed, 150u);
      EXPECT_LE(found, (has_times ? 8 : 3) * needed) << "of " << rows << " rows";
    }
  }
}

TEST(ScanPatches, ThoseInAPlaceHoldAllItsRows) {
  // Rows in a coil: those that follow each other are near each other.
  RawScan raw;
  for (std::uint64_t i = 0; i < 1700; ++i) {
    const RandomSource one = RandomSource(3).fork(i);
    const double turn = 0.01 * static_cast<double>(i);
    raw.points.emplace_back(20.0 * std::cos(turn) + one.uniform(0), 20.0 * std::sin(turn) + one.uniform(1),
                            0.002 * static_cast<double>(i) + one.uniform(2));
  }
  raw.doppler.assign(raw.points.size(), 0.0);
  const Scan scan = Scan::from_raw(raw);
  ASSERT_EQ(scan.size(), raw.points.size());
  ScanPatches patches;
  patches.bound(scan, Workers(3));
  for (const double reach : {0.5, 3.0, 12.0, 60.0}) {
    SoughtPlace place;
    place.centre = Vector3d(-20.0, 3.0, 2.0);
    place.reach_m = reach;
    place.half_height_m = reach;
    std::vector<std::uint32_t> visited;
    patches.visit(place, [&](std::size_t begin, std::size_t end) {
      ASSERT_EQ(begin % PatchBlock::kRows, 0u);
      ASSERT_EQ(end, std::min<std::size_t>(begin + PatchBlock::kRows, 1700));
      for (std::size_t row = begin; row < end; ++row) {
        visited.push_back(static_cast<std::uint32_t>(row));
      }
    });
    EXPECT_TRUE(std::is_sorted(visited.begin(), visited.end()));
    for (std::uint32_t row = 0; row < raw.points.size(); ++row) {
      if ((raw.points[row] - place.centre).norm() <= reach) {
        EXPECT_TRUE(std::binary_search(visited.begin(), visited.end(), row)) << row << " within " << reach;
      }
    }
    EXPECT_EQ(visited.size() == 1700, reach == 60.0);
  }
}

}  // namespace
}  // namespace dynamic_icp::tracking
