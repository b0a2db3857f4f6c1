// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/ray_returns.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "testing/scanned_worlds.hpp"

namespace dynamic_icp::simulation {
namespace {

/// The share of returns at this signal-to-noise ratio over the one that is seen every second time.
double expected_share(double relative_snr) {
  return std::pow(1e-6, 1.0 / (1.0 + relative_snr * (std::log(1e-6) / std::log(0.5) - 1.0)));
}

TEST(RayReturns, DetectionFallsWithRange) {
  for (const double distance : {40.0, 100.0, 200.0}) {
    Wall wall(distance + 0.1, 0.1);
    EXPECT_EQ(wall.share(), 1.0) << "off";
    wall.config.detection_range_m = 100.0;
    const double expected = expected_share(std::pow(100.0 / distance, 2));
    EXPECT_NEAR(wall.share(), expected, share_error(expected, 20000.0)) << distance;
  }
  EXPECT_NEAR(expected_share(1.0), 0.5, 1e-12);
}

TEST(RayReturns, DetectionFallsOnDarkSurfaces) {
  Wall wall(100.1, 0.03);
  wall.config.detection_range_m = 100.0;
  EXPECT_NEAR(wall.share(), expected_share(0.3), share_error(expected_share(0.3), 20000.0));
  wall.config.weak_when_dark = false;
  EXPECT_NEAR(wall.share(), 0.5, share_error(0.5, 20000.0));
}

TEST(RayReturns, DetectionFallsOnSlantedSurfaces) {
  Wall wall(100.2, 0.1, 60.0);
  wall.config.detection_range_m = 100.0;
  // Over one degree of view the slanted wall is met between 98.5 and 101.5 m and at 59.5 to 60.5 degrees.
  EXPECT_NEAR(wall.share(), expected_share(0.5), share_error(expected_share(0.5), 20000.0) + 0.002);
  wall.config.weak_when_slanted = false;
  EXPECT_NEAR(wall.share(), 0.5, share_error(0.5, 20000.0) + 0.002);
}

TEST(RayReturns, IntensityFollowsTheSquareOfTheRange) {
  const SimulatedScan near = Wall(10.1, 0.1).scan();
  const SimulatedScan far = Wall(100.1, 0.4).scan();
  EXPECT_NEAR(near.intensity_db.front(), -20.0, 0.01);
  EXPECT_NEAR(far.intensity_db.front(), -40.0 + 10.0 * std::log10(4.0), 0.01);
  EXPECT_FLOAT_EQ(far.reflectivity.front(), 0.4F);
}

TEST(RayReturns, RainHasItsRateRangeAndVelocity) {
  Wall wall(1500.0, 0.3);
  wall.config.rain_rate = 0.2;
  wall.config.rain_range_m = 6.0;
  wall.config.vertical_center_deg = 80.0;  // drops fall along the line of sight
  const SimulatedScan scan = wall.scan();
  Statistics range, doppler;
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    ASSERT_EQ(scan.kinds[i] == ReturnKind::kRain, scan.bodies[i] == kNoBody);
    if (scan.kinds[i] == ReturnKind::kRain) {
      range.add(scan.true_range[i]);
      doppler.add(scan.true_doppler[i]);
      EXPECT_EQ(scan.measured.doppler[i], scan.true_doppler[i]);
    }
  }
  // An exponential distribution without what is nearer than the minimum range of 1 m.
  const double rate = 0.2 * std::exp(-1.0 / 6.0);
  EXPECT_NEAR(range.n / 20000.0, rate, share_error(rate, 20000.0));
  EXPECT_NEAR(range.mean(), 7.0, 4.0 * 6.0 / std::sqrt(range.n));
  EXPECT_NEAR(doppler.mean(), -6.0 * std::sin(80.0 * std::numbers::pi / 180.0), 4.0 / std::sqrt(doppler.n) + 0.01);
  EXPECT_NEAR(doppler.deviation(), 1.0, 4.0 / std::sqrt(2.0 * doppler.n) + 0.01);
}

/// A near plate in front of a far wall: its edge runs down the middle of the view.
struct Edge : Wall {
  explicit Edge(double step_m) : Wall(50.0 + step_m + 0.1, 0.3) {
    append(world.statics, world::painted(world::make_box({0.001, 1000.0, 1000.0}), 0.3),
           Eigen::Isometry3d(Eigen::Translation3d(50.0, 500.0, 0.0)));
    caster = std::make_unique<world::RayCaster>(world);
    config.horizontal_fov_deg = 1.0;  // 0.0873 mrad a column
    config.beam_divergence_mrad = 2.0;
  }
};

TEST(RayReturns, BeamsOnAnEdgeGiveMixedReturns) {
  Edge edge(0.6);
  const SimulatedScan scan = edge.scan();
  std::size_t mixed = 0;
  std::size_t between = 0;
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    const Vector3d& p = scan.measured.points[i];
    const double azimuth_mrad = 1000.0 * std::atan2(p.y(), p.x());
    if (scan.kinds[i] == ReturnKind::kMixed) {
      EXPECT_TRUE(p.x() > 50.0 - 1e-3 && p.x() < 50.6 + 1e-3) << p.x();
      EXPECT_LT(std::abs(azimuth_mrad), 1.1) << "far from the edge";
      between += p.x() > 50.1 && p.x() < 50.5 ? 1 : 0;
    } else {
      EXPECT_TRUE(std::abs(p.x() - 50.0) < 0.01 || std::abs(p.x() - 50.6) < 0.01) << p.x();
    }
    mixed += scan.kinds[i] == ReturnKind::kMixed ? 1 : 0;
  }
  // A second ray, uniform over a disk of 1 mrad radius, falls beyond an edge at distance x with the probability of the
  // disk's segment; over x from -1 to 1 mrad its integral is 2 * 2 / (3 pi) mrad.
  const double expected = 2.0 * 2.0 / (3.0 * std::numbers::pi) / (1.0 * 1000.0 * std::numbers::pi / 180.0);
  EXPECT_NEAR(static_cast<double>(mixed) / 20000.0, expected, share_error(expected, 20000.0) + 0.001);
  // The share of the beam on the second surface is uniform from 0 to 1/2, and so is the place of the point from either
  // surface to the middle: a third of it lies outside of these 0.4 m.
  EXPECT_NEAR(static_cast<double>(between) / static_cast<double>(mixed), 2.0 / 3.0,
              share_error(2.0 / 3.0, static_cast<double>(mixed)));
}

TEST(RayReturns, BlackSurfacesGiveFiniteReturnsAtEdges) {
  Edge edge(0.6);
  edge.world.statics = painted(edge.world.statics, 0.0);
  edge.caster = std::make_unique<world::RayCaster>(edge.world);
  const SimulatedScan scan = edge.scan();
  EXPECT_GT(std::count(scan.kinds.begin(), scan.kinds.end(), ReturnKind::kMixed), 0);
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    ASSERT_TRUE(scan.measured.points[i].allFinite() && std::isfinite(scan.measured.doppler[i]));
  }
}

TEST(RayReturns, ResolvedSurfacesAreNotMixed) {
  Edge edge(5.0);
  const SimulatedScan scan = edge.scan();
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    EXPECT_EQ(scan.kinds[i], ReturnKind::kSurface);
    const double x = scan.measured.points[i].x();
    EXPECT_TRUE(std::abs(x - 50.0) < 0.01 || std::abs(x - 55.0) < 0.01) << x;
  }
  edge.config.beam_divergence_mrad = 0.0;
  EXPECT_EQ(edge.scan().bodies.size(), 20000U);
}

TEST(RayReturns, SlantedAndSmoothSurfacesHaveNoEdges) {
  Wall wall(60.0, 0.3, 85.0);
  wall.config.beam_divergence_mrad = 2.0;
  const SimulatedScan scan = wall.scan();
  EXPECT_EQ(std::count(scan.kinds.begin(), scan.kinds.end(), ReturnKind::kMixed), 0);
}

TEST(RayReturns, RoughSurfacesHaveTheirHeightAlongTheNormalAndKeepIt) {
  for (const double slant_deg : {0.0, 60.0}) {
    Wall wall(100.0, 0.3, slant_deg);
    const SimulatedScan smooth = wall.scan();
    wall.config.roughness_m = 0.005;
    const SimulatedScan scan = wall.scan();
    ASSERT_EQ(scan.bodies.size(), smooth.bodies.size());
    const Vector3d normal(std::cos(slant_deg * std::numbers::pi / 180.0),
                          std::sin(slant_deg * std::numbers::pi / 180.0), 0.0);
    Statistics heights;
    for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
      heights.add(normal.dot(scan.measured.points[i] - smooth.measured.points[i]));
      EXPECT_NEAR(scan.measured.points[i].norm(), scan.true_range[i], 1e-9) << "it is no error of measurement";
    }
    EXPECT_NEAR(heights.mean(), 0.0, 4.0 * 0.005 / std::sqrt(heights.n));
    EXPECT_NEAR(heights.deviation(), 0.005, 4.0 * 0.005 / std::sqrt(2.0 * heights.n));
    wall.config.dropout_rate = 1e-9;
    EXPECT_EQ(wall.scan().measured.points, scan.measured.points);
  }
}

TEST(RayReturns, LeavesSwayAndTheirDopplerIsTheChangeOfRange) {
  Wall wall(20.1, 0.5);
  wall.world.statics = world::leafy(wall.world.statics);
  wall.caster = std::make_unique<world::RayCaster>(wall.world);
  wall.config.horizontal_fov_deg = wall.config.vertical_fov_deg = 60.0;
  EXPECT_EQ(wall.scan().measured.doppler.front(), 0.0);
  wall.config.foliage_sway_m = 0.05;
  const ScanPattern pattern = scan_pattern(wall.config);
  const auto scan_at = [&](std::int64_t ns) {
    return simulate_scan({wall.world, *wall.caster, wall.sensor}, pattern, SensorUnit(wall.config), {Stamp{ns}},
                         RandomSource(3), Workers(1));
  };
  const SimulatedScan before = scan_at(1'000'000'000);
  const SimulatedScan now = scan_at(1'001'000'000);
  const SimulatedScan after = scan_at(1'002'000'000);
  Statistics doppler;
  for (std::size_t i = 0; i < now.bodies.size(); ++i) {
    EXPECT_EQ(now.bodies[i], 0);
    EXPECT_NEAR(now.measured.doppler[i], (after.true_range[i] - before.true_range[i]) / 0.002, 2e-4);
    doppler.add(now.measured.doppler[i]);
  }
  EXPECT_GT(doppler.deviation(), 0.05);
  EXPECT_LT(doppler.deviation(), 0.5);
}

}  // namespace
}  // namespace dynamic_icp::simulation
