// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/pointing_error.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "testing/scanned_worlds.hpp"

namespace dynamic_icp::simulation {
namespace {

/// Azimuth and elevation measured minus those of the pattern, in deg, by group.
using Offsets = std::map<int, std::array<Statistics, 2>>;

template <class Group>
Offsets offsets(const SimulatedScan& scan, const ScanPattern& pattern, const Group& group_of) {
  Offsets groups;
  const std::size_t rays = pattern.front().rays.size();
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    const PatternRay& ray = pattern[i / rays].rays[i % rays];
    const Vector3d& p = scan.measured.points[i];
    auto& group = groups[group_of(i)];
    group[0].add(180.0 / std::numbers::pi * (std::atan2(p.y(), p.x()) - ray.azimuth_rad));
    group[1].add(180.0 / std::numbers::pi * (std::asin(p.z() / p.norm()) - ray.elevation_rad));
  }
  return groups;
}

/// Checks that each group has constants of this standard deviation between them.
void expect_constants(const Offsets& groups, double sigma_deg) {
  for (const std::size_t axis : {0U, 1U}) {
    double squares = 0.0;
    for (const auto& [group, statistics] : groups) {
      EXPECT_LT(statistics[axis].deviation(), 1e-6) << group;
      squares += std::pow(statistics[axis].mean(), 2);
    }
    const auto n = static_cast<double>(groups.size());
    EXPECT_NEAR(std::sqrt(squares / n), sigma_deg, 4.0 * sigma_deg / std::sqrt(2.0 * n)) << axis;
  }
}

TEST(PointingError, LinesAndFacesAreTurned) {
  Room room;
  room.config.columns = 30;
  room.config.rows = 600;
  room.config.pointing_error.line_deg = 0.05;
  ScanPattern pattern = scan_pattern(room.config);
  const SimulatedScan lines = room.scan(pattern);
  ASSERT_EQ(lines.bodies.size(), 30U * 600U);
  expect_constants(offsets(lines, pattern, [&](std::size_t i) { return lines.lines[i]; }), 0.05);
  for (std::size_t i = 0; i < lines.bodies.size(); ++i) {
    EXPECT_NEAR(lines.measured.points[i].norm(), lines.true_range[i], 1e-9);
    EXPECT_EQ(lines.measured.doppler[i], lines.true_doppler[i]) << "the ray went where it was aimed";
  }
  room.config.pointing_error = {};
  room.config.pointing_error.face_deg = 0.1;
  room.config.faces = 15;
  pattern = scan_pattern(room.config);
  const SimulatedScan faces = room.scan(pattern);
  expect_constants(offsets(faces, pattern, [&](std::size_t i) { return faces.faces[i]; }), 0.1);
}

TEST(PointingError, BeamsHaveRangesOfTheirOwn) {
  Room room;
  room.config.beams = 15;
  room.config.rows = 60;
  room.config.pointing_error.beam_range_m = 0.03;
  const SimulatedScan scan = room.scan(scan_pattern(room.config));
  std::map<int, Statistics> beams;
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    beams[scan.beams[i]].add(scan.measured.points[i].norm() - scan.true_range[i]);
  }
  ASSERT_EQ(beams.size(), 15U);
  double squares = 0.0;
  for (const auto& [beam, statistics] : beams) {
    EXPECT_LT(statistics.deviation(), 1e-6);
    squares += std::pow(statistics.mean(), 2) / 15.0;
  }
  EXPECT_NEAR(std::sqrt(squares), 0.03, 4.0 * 0.03 / std::sqrt(30.0));
}

}  // namespace
}  // namespace dynamic_icp::simulation
