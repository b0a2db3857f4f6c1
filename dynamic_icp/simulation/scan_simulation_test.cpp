// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/simulation/scan_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "dynamic_icp/simulation/drive.hpp"

namespace dynamic_icp::simulation {
namespace {

using Eigen::Vector3d;

/// A room around a sensor that drives, turns and nods in it, with a spinning, drifting box in front.
struct Fixture {
  World world;
  std::unique_ptr<RayCaster> caster;
  Trajectory sensor;
  FmcwLidarConfig config = without_noise({});

  Fixture() {
    world.statics = make_box({60.0, 50.0, 20.0});
    world.shapes = {make_box({4.0, 2.0, 3.0})};
    add_body(world, "box", 0, [](double t) {
      MotionState state;
      state.T_world_body.translation() << 12.0 + 2.0 * t, 1.0 - 3.0 * t, 0.5;
      state.T_world_body.linear() = Eigen::AngleAxisd(1.5 * t, Vector3d::UnitZ()).toRotationMatrix();
      state.velocity_world << 2.0, -3.0, 0.0;
      state.angular_velocity_world << 0.0, 0.0, 1.5;
      return state;
    });
    caster = std::make_unique<RayCaster>(world);
    const auto route = std::make_shared<const Route>(std::vector<RoutePiece>{{60.0, 0.05, 0.05}});
    const Trajectory vehicle = drive(route, SpeedProfile(9.0), {}, [](double t, const PlanarState&) {
      return Sway{0.1 * std::sin(t), 0.05 * std::sin(2.0 * t), 0.0, 0.1 * std::cos(t), 0.1 * std::cos(2.0 * t), 0.0};
    });
    MountConfig mount{1.5, 0.7, 1.9, 6.0, -4.0, 12.0};
    sensor = [vehicle, T = T_vehicle_sensor(mount)](double t) { return mounted(vehicle(t), T); };
    config.columns = 120;
    config.rows = 16;
  }

  [[nodiscard]] SimulatedScan scan(const ScanPattern& pattern, std::int64_t stamp_ns = 300'000'000,
                                   int threads = 1) const {
    return simulate_scan({world, *caster, sensor}, pattern, config, Stamp{stamp_ns}, RandomSource(9), Workers(threads));
  }
};

/// The range rate measured by moving everything on for a moment: the change of the distance between the sensor and the
/// material point that was met. Independent of any twist.
double finite_range_rate(const Fixture& f, double t, const Vector3d& point_sensor, std::int32_t body) {
  const double h = 1e-5;
  const Vector3d point_world = f.sensor(t).T_world_body * point_sensor;
  const auto distance = [&](double time) {
    Vector3d point = point_world;
    if (body > 0) {
      const Trajectory& trajectory = f.world.bodies[static_cast<std::size_t>(body - 1)].trajectory;
      point = trajectory(time).T_world_body * (trajectory(t).T_world_body.inverse() * point_world);
    }
    return (point - f.sensor(time).T_world_body.translation()).norm();
  };
  return (distance(t + h) - distance(t - h)) / (2.0 * h);
}

TEST(SimulateScan, NothingInRangeGivesAnEmptyScan) {
  Fixture f;
  f.config.max_range_m = 2.0;
  f.config.min_range_m = 1.0;
  const SimulatedScan scan = f.scan(instant_pattern(f.config));
  EXPECT_TRUE(scan.measured.points.empty());
  EXPECT_TRUE(scan.bodies.empty());
  EXPECT_TRUE(f.scan({}).measured.points.empty());
}

TEST(SimulateScan, PoseThatIsNotFiniteIsRefused) {
  Fixture f;
  f.sensor = [](double) {
    MotionState state;
    state.T_world_body.translation().x() = std::nan("");
    return state;
  };
  EXPECT_THROW((void)f.scan(instant_pattern(f.config)), std::invalid_argument);
}

TEST(SimulateScan, DopplerIsTheRangeRateOnStaticAndTurningBodies) {
  const Fixture f;
  const SimulatedScan scan = f.scan(instant_pattern(f.config));
  ASSERT_EQ(scan.measured.points.size(), 120U * 16U);
  const auto on_body = std::count(scan.bodies.begin(), scan.bodies.end(), 1);
  EXPECT_GT(on_body, 30);
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    const double expected = finite_range_rate(f, 0.3, scan.measured.points[i], scan.bodies[i]);
    EXPECT_NEAR(scan.measured.doppler[i], expected, 1e-6) << i;
  }
}

TEST(SimulateScan, EachRayHasTheWorldOfItsOwnTime) {
  const Fixture f;
  ScanPattern pattern = instant_pattern(f.config);
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    pattern[i].time_s = 0.1 * static_cast<double>(i) / static_cast<double>(pattern.size());
  }
  const SimulatedScan scan = f.scan(pattern);
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
  Fixture f;
  f.config = {};
  f.config.columns = 1200;
  f.config.doppler_bias_mps = 0.3;
  f.config.doppler_outlier_rate = 0.02;
  const SimulatedScan scan = f.scan(instant_pattern(f.config));
  const double rays = 1200.0 * 64.0;
  const auto n = static_cast<double>(scan.bodies.size());
  EXPECT_NEAR(n / rays, 1.0 - 0.03, 4.0 * std::sqrt(0.03 * 0.97 / rays));

  double range_sum = 0.0, range_squares = 0.0, doppler_sum = 0.0, doppler_squares = 0.0, inliers = 0.0;
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    const double range_error = scan.measured.points[i].norm() - scan.true_range[i];
    range_sum += range_error;
    range_squares += range_error * range_error;
    const double doppler_error = scan.measured.doppler[i] - scan.true_doppler[i] - 0.3;
    if (std::abs(doppler_error) < 6.0 * 0.05) {
      doppler_sum += doppler_error;
      doppler_squares += doppler_error * doppler_error;
      inliers += 1.0;
    }
  }
  EXPECT_NEAR(range_sum / n, 0.0, 4.0 * 0.02 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(range_squares / n), 0.02, 4.0 * 0.02 / std::sqrt(2.0 * n));
  EXPECT_NEAR(doppler_sum / inliers, 0.0, 4.0 * 0.05 / std::sqrt(inliers));
  // Outliers that happen to fall among the inliers: 0.02 * 0.6 / 60 of all; they widen the spread a little.
  EXPECT_NEAR(std::sqrt(doppler_squares / inliers), 0.05, 4.0 * 0.05 / std::sqrt(2.0 * inliers) + 1.5e-4);
  const double outlier_rate = 0.02 * (1.0 - 0.6 / 60.0);
  EXPECT_NEAR(1.0 - inliers / n, outlier_rate, 4.0 * std::sqrt(outlier_rate / n));
}

TEST(SimulateScan, QuantisedDopplerIsAMultipleOfTheStep) {
  Fixture f;
  f.config.doppler_step_mps = 1.0 / 256.0;
  const SimulatedScan scan = f.scan(instant_pattern(f.config));
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    const double steps = scan.measured.doppler[i] * 256.0;
    EXPECT_EQ(steps, std::round(steps));
    EXPECT_LE(std::abs(scan.measured.doppler[i] - scan.true_doppler[i]), 0.5 / 256.0 + 1e-12);
  }
}

TEST(SimulateScan, OneEffectDoesNotDisturbAnother) {
  Fixture f;
  f.config.range_noise_m = 0.02;
  const SimulatedScan without = f.scan(instant_pattern(f.config));
  f.config.doppler_outlier_rate = 0.5;
  const SimulatedScan with = f.scan(instant_pattern(f.config));
  ASSERT_EQ(with.bodies.size(), without.bodies.size());
  for (std::size_t i = 0; i < with.bodies.size(); ++i) {
    EXPECT_EQ(with.measured.points[i], without.measured.points[i]);
  }
}

TEST(SimulateScan, SameBitsForAnyNumberOfThreads) {
  Fixture f;
  f.config = {};
  const ScanPattern pattern = instant_pattern(f.config);
  const SimulatedScan expected = f.scan(pattern, 300'000'000, 1);
  for (const int threads : {1, 2, 7}) {
    const SimulatedScan scan = f.scan(pattern, 300'000'000, threads);
    EXPECT_EQ(scan.measured.points, expected.measured.points);
    EXPECT_EQ(scan.measured.doppler, expected.measured.doppler);
    EXPECT_EQ(scan.bodies, expected.bodies);
  }
}

}  // namespace
}  // namespace dynamic_icp::simulation
