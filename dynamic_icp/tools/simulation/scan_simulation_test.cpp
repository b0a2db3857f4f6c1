// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/scan_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <tuple>

#include <gtest/gtest.h>

#include "testing/scanned_worlds.hpp"

namespace dynamic_icp::simulation {
namespace {

/// The range rate measured by moving everything on for a moment: the change of the distance between the sensor and the
/// material point that was met. Independent of any twist.
double finite_range_rate(const Room& f, double t, const Vector3d& point_sensor, std::int32_t body) {
  const double h = 1e-5;
  const Vector3d point_world = f.sensor(t).T_world_body * point_sensor;
  const auto distance = [&](double time) {
    Vector3d point = point_world;
    if (body > 0) {
      const world::Trajectory& trajectory = f.world.bodies[static_cast<std::size_t>(body - 1)].trajectory;
      point = trajectory(time).T_world_body * (trajectory(t).T_world_body.inverse() * point_world);
    }
    return (point - f.sensor(time).T_world_body.translation()).norm();
  };
  return (distance(t + h) - distance(t - h)) / (2.0 * h);
}

TEST(SimulateScan, NothingInRangeGivesAnEmptyScan) {
  Room f;
  f.config.max_range_m = 2.0;
  f.config.min_range_m = 1.0;
  const SimulatedScan scan = f.scan(scan_pattern(f.config));
  EXPECT_TRUE(scan.measured.points.empty());
  EXPECT_TRUE(scan.bodies.empty());
  EXPECT_TRUE(f.scan({}).measured.points.empty());
}

TEST(SimulateScan, PoseThatIsNotFiniteIsRefused) {
  Room f;
  f.sensor = [](double) {
    world::MotionState state;
    state.T_world_body.translation().x() = std::nan("");
    return state;
  };
  EXPECT_THROW((void)f.scan(scan_pattern(f.config)), std::invalid_argument);
}

TEST(SimulateScan, DopplerIsTheRangeRateOnStaticAndTurningBodies) {
  const Room f;
  const SimulatedScan scan = f.scan(scan_pattern(f.config));
  ASSERT_EQ(scan.measured.points.size(), 120U * 16U);
  const auto on_body = std::count(scan.bodies.begin(), scan.bodies.end(), 1);
  EXPECT_GT(on_body, 30);
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    const double expected = finite_range_rate(f, 0.3, scan.measured.points[i], scan.bodies[i]);
    EXPECT_NEAR(scan.measured.doppler[i], expected, 1e-6) << i;
  }
}

TEST(SimulateScan, EachRayHasTheWorldOfItsOwnTime) {
  Room f;
  f.config.sweep_s = 0.1;
  const SimulatedScan scan = f.scan(scan_pattern(f.config));
  EXPECT_EQ(scan.measured.times.front(), 0.0);
  EXPECT_NEAR(scan.measured.times.back(), 0.1 * 119.0 / 120.0, 1e-12);
  ASSERT_EQ(scan.measured.points.size(), 120U * 16U);
  const Vector3d half(30.0, 25.0, 10.0);
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    const double t = 0.3 + scan.measured.times[i];
    EXPECT_NEAR(scan.measured.doppler[i], finite_range_rate(f, t, scan.measured.points[i], scan.bodies[i]), 1e-6);
    if (scan.bodies[i] == 0) {
      const Vector3d p = f.sensor(t).T_world_body * scan.measured.points[i];
      EXPECT_NEAR((half - p.cwiseAbs()).minCoeff(), 0.0, 1e-9) << "not on a wall of the room";
    }
  }
}

TEST(SimulateScan, NoiseHasTheStatisticsAskedFor) {
  Room f;
  f.config.columns = 1200;
  f.config.rows = 64;
  f.config.range_noise_m = 0.02;
  f.config.doppler_noise_mps = 0.05;
  f.config.doppler_bias_mps = 0.3;
  f.config.doppler_outlier_rate = 0.02;
  f.config.dropout_rate = 0.03;
  const SimulatedScan scan = f.scan(scan_pattern(f.config));
  const double rays = 1200.0 * 64.0;
  const auto n = static_cast<double>(scan.bodies.size());
  EXPECT_NEAR(n / rays, 1.0 - 0.03, share_error(0.03, rays));

  Statistics range_error, doppler_error;
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    range_error.add(scan.measured.points[i].norm() - scan.true_range[i]);
    const double error = scan.measured.doppler[i] - scan.true_doppler[i] - 0.3;
    if (std::abs(error) < 6.0 * 0.05) {
      doppler_error.add(error);
    }
  }
  EXPECT_NEAR(range_error.mean(), 0.0, 4.0 * 0.02 / std::sqrt(n));
  EXPECT_NEAR(range_error.deviation(), 0.02, 4.0 * 0.02 / std::sqrt(2.0 * n));
  EXPECT_NEAR(doppler_error.mean(), 0.0, 4.0 * 0.05 / std::sqrt(n));
  // Outliers that happen to fall among the inliers: 0.02 * 0.6 / 60 of all; they widen the spread a little.
  EXPECT_NEAR(doppler_error.deviation(), 0.05, 4.0 * 0.05 / std::sqrt(2.0 * n) + 1.5e-4);
  const double outlier_rate = 0.02 * (1.0 - 0.6 / 60.0);
  EXPECT_NEAR(1.0 - doppler_error.n / n, outlier_rate, share_error(outlier_rate, n));
}

TEST(SimulateScan, AngleNoiseTurnsThePointAndNotItsRange) {
  Room f;
  f.config.columns = 1200;
  f.config.angle_noise_deg = 0.2;
  const ScanPattern pattern = scan_pattern(f.config);
  const SimulatedScan scan = f.scan(pattern);
  ASSERT_EQ(scan.bodies.size(), 1200U * 16U);
  Statistics across, up;
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    const Vector3d& p = scan.measured.points[i];
    EXPECT_NEAR(p.norm(), scan.true_range[i], 1e-9);
    const PatternRay& ray = pattern[i / 16].rays[i % 16];
    across.add(std::atan2(p.y(), p.x()) - ray.azimuth_rad);
    up.add(std::asin(p.z() / p.norm()) - ray.elevation_rad);
  }
  const double sigma = 0.2 * std::numbers::pi / 180.0;
  EXPECT_NEAR(across.deviation(), sigma, 4.0 * sigma / std::sqrt(2.0 * across.n));
  EXPECT_NEAR(up.deviation(), sigma, 4.0 * sigma / std::sqrt(2.0 * up.n));
  EXPECT_NEAR(across.mean(), 0.0, 4.0 * sigma / std::sqrt(across.n));
}

TEST(SimulateScan, ScatterMovesTheRayAndThePointStaysOnTheSurface) {
  Room f;
  f.config.columns = 1200;
  f.config.scatter_deg = 0.5;
  const ScanPattern pattern = scan_pattern(f.config);
  const SimulatedScan scan = f.scan(pattern);
  const Vector3d half(30.0, 25.0, 10.0);
  Statistics across;
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    if (scan.bodies[i] == 0) {
      const Vector3d p = f.sensor(0.3).T_world_body * scan.measured.points[i];
      ASSERT_NEAR((half - p.cwiseAbs()).minCoeff(), 0.0, 1e-9);
    }
    const Vector3d& p = scan.measured.points[i];
    across.add((std::atan2(p.y(), p.x()) - pattern[i / 16].rays[i % 16].azimuth_rad) * 180.0 / std::numbers::pi);
  }
  EXPECT_NEAR(across.deviation(), 0.5 / std::sqrt(3.0), 0.01);  // of a uniform number in [-0.5, 0.5]
  EXPECT_NE(f.scan(pattern, 400'000'000).measured.points, scan.measured.points);
}

TEST(SimulateScan, QuantisedDopplerIsAMultipleOfTheStep) {
  Room f;
  f.config.doppler_step_mps = 1.0 / 256.0;
  const SimulatedScan scan = f.scan(scan_pattern(f.config));
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    const double steps = scan.measured.doppler[i] * 256.0;
    EXPECT_EQ(steps, std::round(steps));
    EXPECT_LE(std::abs(scan.measured.doppler[i] - scan.true_doppler[i]), 0.5 / 256.0 + 1e-12);
  }
}

TEST(SimulateScan, QuantisedRangeIsAMultipleOfTheStep) {
  Room f;
  f.config.range_step_m = 1.0 / 128.0;
  const SimulatedScan scan = f.scan(scan_pattern(f.config));
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    const double steps = scan.measured.points[i].norm() * 128.0;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    EXPECT_LE(std::abs(scan.measured.points[i].norm() - scan.true_range[i]), 0.5 / 128.0 + 1e-12);
  }
}

TEST(SimulateScan, BlindSectorsHaveNoReturns) {
  Room room;
  for (const auto& [from, to, lost] : {std::tuple{-10.0, 20.0, 30}, std::tuple{50.0, -50.0, 20}}) {
    room.config.blind_from_deg = from;
    room.config.blind_to_deg = to;
    const SimulatedScan scan = room.scan(scan_pattern(room.config));
    EXPECT_EQ(scan.bodies.size(), (120U - static_cast<std::size_t>(lost)) * 16U) << "one degree a column";
    for (const Vector3d& p : scan.measured.points) {
      const double azimuth = 180.0 / std::numbers::pi * std::atan2(p.y(), p.x());
      EXPECT_FALSE(from < to ? azimuth > from && azimuth < to : azimuth > from || azimuth < to) << azimuth;
    }
  }
}

TEST(SimulateScan, DuplicatesAreWholePoints) {
  Room room;
  room.config.range_noise_m = 0.02;
  const SimulatedScan without = room.scan(scan_pattern(room.config));
  room.config.duplicate_rate = 0.1;
  const SimulatedScan scan = room.scan(scan_pattern(room.config));
  double twice = 0.0;
  for (std::size_t i = 1; i < scan.bodies.size(); ++i) {
    if (scan.measured.points[i] == scan.measured.points[i - 1]) {
      twice += 1.0;
      EXPECT_EQ(scan.true_range[i], scan.true_range[i - 1]);
      EXPECT_EQ(scan.lines[i], scan.lines[i - 1]);
    }
  }
  EXPECT_EQ(scan.bodies.size(), without.bodies.size() + static_cast<std::size_t>(twice));
  EXPECT_NEAR(twice / 1920.0, 0.1, share_error(0.1, 1920.0));
}

TEST(SimulateScan, OneEffectDoesNotDisturbAnother) {
  Room f;
  f.config.range_noise_m = 0.02;
  const SimulatedScan without = f.scan(scan_pattern(f.config));
  f.config.doppler_outlier_rate = 0.5;
  const SimulatedScan with = f.scan(scan_pattern(f.config));
  ASSERT_EQ(with.bodies.size(), without.bodies.size());
  for (std::size_t i = 0; i < with.bodies.size(); ++i) {
    EXPECT_EQ(with.measured.points[i], without.measured.points[i]);
  }
}

TEST(SimulateScan, SameBitsForAnyNumberOfThreads) {
  Room f;
  f.config.sweep_s = 0.1;
  f.config.detection_range_m = 30.0;
  f.config.beam_divergence_mrad = 3.0;
  f.config.rain_rate = 0.1;
  f.config.range_noise_m = 0.02;
  f.config.doppler_noise_mps = 0.05;
  f.config.doppler_error.firing_noise_mps = 0.05;
  f.config.doppler_error.direction_mps = 0.1;
  f.config.multipath_rate = 0.05;
  f.config.duplicate_rate = 0.05;
  const ScanPattern pattern = scan_pattern(f.config);
  const SimulatedScan expected = f.scan(pattern, 300'000'000, 1);
  for (const int threads : {1, 2, 7}) {
    const SimulatedScan scan = f.scan(pattern, 300'000'000, threads);
    EXPECT_EQ(scan.measured.points, expected.measured.points);
    EXPECT_EQ(scan.measured.doppler, expected.measured.doppler);
    EXPECT_EQ(scan.bodies, expected.bodies);
    EXPECT_EQ(scan.kinds, expected.kinds);
    EXPECT_EQ(scan.intensity_db, expected.intensity_db);
  }
}

}  // namespace
}  // namespace dynamic_icp::simulation
