// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/scan_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "dynamic_icp/tools/simulation/mount.hpp"
#include "dynamic_icp/tools/world/drive.hpp"

namespace dynamic_icp::simulation {
namespace {

using Eigen::Vector3d;

/// A room around a sensor that drives, turns and nods in it, with a spinning, drifting box in front.
struct Fixture {
  world::World world;
  std::unique_ptr<world::RayCaster> caster;
  world::Trajectory sensor;
  FmcwLidarConfig config;

  Fixture() {
    world.statics = world::make_box({60.0, 50.0, 20.0});
    add_shape(world, world::make_box({4.0, 2.0, 3.0}));
    world::add_body(world, "box", 0, [](double t) {
      world::MotionState state;
      state.T_world_body.translation() << 12.0 + 2.0 * t, 1.0 - 3.0 * t, 0.5;
      state.T_world_body.linear() = Eigen::AngleAxisd(1.5 * t, Vector3d::UnitZ()).toRotationMatrix();
      state.velocity_world << 2.0, -3.0, 0.0;
      state.angular_velocity_world << 0.0, 0.0, 1.5;
      return state;
    });
    caster = std::make_unique<world::RayCaster>(world);
    const auto route = std::make_shared<const world::Route>(std::vector<world::RoutePiece>{{60.0, 0.05, 0.05}});
    const world::Trajectory vehicle =
        world::drive(route, world::SpeedProfile(9.0), {}, [](double t, const world::PlanarState&) {
          return world::Sway{0.1 * std::sin(t), 0.05 * std::sin(2.0 * t), 0.0,
                             0.1 * std::cos(t), 0.1 * std::cos(2.0 * t),  0.0};
        });
    MountConfig mount{1.5, 0.7, 1.9, 6.0, -4.0, 12.0};
    sensor = [vehicle, T = T_vehicle_sensor(mount)](double t) { return world::mounted(vehicle(t), T); };
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
      const world::Trajectory& trajectory = f.world.bodies[static_cast<std::size_t>(body - 1)].trajectory;
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
  const SimulatedScan scan = f.scan(scan_pattern(f.config));
  EXPECT_TRUE(scan.measured.points.empty());
  EXPECT_TRUE(scan.bodies.empty());
  EXPECT_TRUE(f.scan({}).measured.points.empty());
}

TEST(SimulateScan, PoseThatIsNotFiniteIsRefused) {
  Fixture f;
  f.sensor = [](double) {
    world::MotionState state;
    state.T_world_body.translation().x() = std::nan("");
    return state;
  };
  EXPECT_THROW((void)f.scan(scan_pattern(f.config)), std::invalid_argument);
}

TEST(SimulateScan, DopplerIsTheRangeRateOnStaticAndTurningBodies) {
  const Fixture f;
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
  Fixture f;
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

/// Sum, mean and standard deviation of numbers.
struct Statistics {
  double n = 0.0;
  double sum = 0.0;
  double squares = 0.0;

  void add(double x) {
    n += 1.0;
    sum += x;
    squares += x * x;
  }
  [[nodiscard]] double mean() const { return sum / n; }
  [[nodiscard]] double deviation() const { return std::sqrt(squares / n - mean() * mean()); }
};

/// Four standard errors of a share measured on n things.
double share_error(double share, double n) { return 4.0 * std::sqrt(share * (1.0 - share) / n); }

TEST(SimulateScan, NoiseHasTheStatisticsAskedFor) {
  Fixture f;
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
  Fixture f;
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
  Fixture f;
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

/// A sensor at rest before one large wall across its view; `slant_deg` turns the wall.
struct Wall {
  world::World world;
  std::unique_ptr<world::RayCaster> caster;
  world::Trajectory sensor = [](double) { return world::MotionState{}; };
  FmcwLidarConfig config;

  Wall(double distance_m, double reflectivity, double slant_deg = 0.0) {
    const Eigen::AngleAxisd slant(slant_deg * std::numbers::pi / 180.0, Vector3d::UnitZ());
    append(world.statics, world::painted(world::make_box({0.2, 2000.0, 2000.0}), reflectivity),
           Eigen::Translation3d(distance_m, 0.0, 0.0) * slant);
    caster = std::make_unique<world::RayCaster>(world);
    // A narrow view: every ray meets the wall at nearly the same range and angle.
    config.horizontal_fov_deg = 1.0;
    config.vertical_fov_deg = 1.0;
    config.columns = 200;
    config.rows = 100;
    config.max_range_m = 2000.0;
  }

  [[nodiscard]] SimulatedScan scan() const {
    return simulate_scan({world, *caster, sensor}, scan_pattern(config), config, Stamp{}, RandomSource(3), Workers(2));
  }
  [[nodiscard]] double share() const { return static_cast<double>(scan().bodies.size()) / 20000.0; }
};

/// The share of returns at this signal-to-noise ratio over the one that is seen every second time.
double expected_share(double relative_snr) {
  return std::pow(1e-6, 1.0 / (1.0 + relative_snr * (std::log(1e-6) / std::log(0.5) - 1.0)));
}

TEST(SimulateScan, DetectionFallsWithRange) {
  for (const double distance : {40.0, 100.0, 200.0}) {
    Wall wall(distance + 0.1, 0.1);
    EXPECT_EQ(wall.share(), 1.0) << "off";
    wall.config.detection_range_m = 100.0;
    const double expected = expected_share(std::pow(100.0 / distance, 2));
    EXPECT_NEAR(wall.share(), expected, share_error(expected, 20000.0)) << distance;
  }
  EXPECT_NEAR(expected_share(1.0), 0.5, 1e-12);
}

TEST(SimulateScan, DetectionFallsOnDarkSurfaces) {
  Wall wall(100.1, 0.03);
  wall.config.detection_range_m = 100.0;
  EXPECT_NEAR(wall.share(), expected_share(0.3), share_error(expected_share(0.3), 20000.0));
  wall.config.weak_when_dark = false;
  EXPECT_NEAR(wall.share(), 0.5, share_error(0.5, 20000.0));
}

TEST(SimulateScan, DetectionFallsOnSlantedSurfaces) {
  Wall wall(100.2, 0.1, 60.0);
  wall.config.detection_range_m = 100.0;
  // Over one degree of view the slanted wall is met between 98.5 and 101.5 m and at 59.5 to 60.5 degrees.
  EXPECT_NEAR(wall.share(), expected_share(0.5), share_error(expected_share(0.5), 20000.0) + 0.002);
  wall.config.weak_when_slanted = false;
  EXPECT_NEAR(wall.share(), 0.5, share_error(0.5, 20000.0) + 0.002);
}

TEST(SimulateScan, IntensityFollowsTheSquareOfTheRange) {
  const SimulatedScan near = Wall(10.1, 0.1).scan();
  const SimulatedScan far = Wall(100.1, 0.4).scan();
  EXPECT_NEAR(near.intensity_db.front(), -20.0, 0.01);
  EXPECT_NEAR(far.intensity_db.front(), -40.0 + 10.0 * std::log10(4.0), 0.01);
  EXPECT_FLOAT_EQ(far.reflectivity.front(), 0.4F);
}

TEST(SimulateScan, RainHasItsRateRangeAndVelocity) {
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

TEST(SimulateScan, BeamsOnAnEdgeGiveMixedReturns) {
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

TEST(SimulateScan, BlackSurfacesGiveFiniteReturnsAtEdges) {
  Edge edge(0.6);
  edge.world.statics = painted(edge.world.statics, 0.0);
  edge.caster = std::make_unique<world::RayCaster>(edge.world);
  const SimulatedScan scan = edge.scan();
  EXPECT_GT(std::count(scan.kinds.begin(), scan.kinds.end(), ReturnKind::kMixed), 0);
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    ASSERT_TRUE(scan.measured.points[i].allFinite() && std::isfinite(scan.measured.doppler[i]));
  }
}

TEST(SimulateScan, ResolvedSurfacesAreNotMixed) {
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

TEST(SimulateScan, SlantedAndSmoothSurfacesHaveNoEdges) {
  Wall wall(60.0, 0.3, 85.0);
  wall.config.beam_divergence_mrad = 2.0;
  const SimulatedScan scan = wall.scan();
  EXPECT_EQ(std::count(scan.kinds.begin(), scan.kinds.end(), ReturnKind::kMixed), 0);
}

TEST(SimulateScan, QuantisedDopplerIsAMultipleOfTheStep) {
  Fixture f;
  f.config.doppler_step_mps = 1.0 / 256.0;
  const SimulatedScan scan = f.scan(scan_pattern(f.config));
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    const double steps = scan.measured.doppler[i] * 256.0;
    EXPECT_EQ(steps, std::round(steps));
    EXPECT_LE(std::abs(scan.measured.doppler[i] - scan.true_doppler[i]), 0.5 / 256.0 + 1e-12);
  }
}

TEST(SimulateScan, QuantisedRangeIsAMultipleOfTheStep) {
  Fixture f;
  f.config.range_step_m = 1.0 / 128.0;
  const SimulatedScan scan = f.scan(scan_pattern(f.config));
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    const double steps = scan.measured.points[i].norm() * 128.0;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    EXPECT_LE(std::abs(scan.measured.points[i].norm() - scan.true_range[i]), 0.5 / 128.0 + 1e-12);
  }
}

TEST(SimulateScan, OneEffectDoesNotDisturbAnother) {
  Fixture f;
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
  Fixture f;
  f.config.sweep_s = 0.1;
  f.config.detection_range_m = 30.0;
  f.config.beam_divergence_mrad = 3.0;
  f.config.rain_rate = 0.1;
  f.config.range_noise_m = 0.02;
  f.config.doppler_noise_mps = 0.05;
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
