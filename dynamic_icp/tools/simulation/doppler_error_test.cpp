// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/doppler_error.hpp"

#include <cmath>
#include <functional>
#include <map>

#include <gtest/gtest.h>

#include "testing/scanned_worlds.hpp"

namespace dynamic_icp::simulation {
namespace {

/// Measured minus true Doppler of each point.
std::vector<double> errors(const SimulatedScan& scan) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    errors.push_back(scan.measured.doppler[i] - scan.true_doppler[i]);
  }
  return errors;
}

/// Statistics of the errors of each group of points.
std::map<int, Statistics> grouped(const SimulatedScan& scan, const std::function<int(std::size_t)>& group_of) {
  std::map<int, Statistics> groups;
  const std::vector<double> values = errors(scan);
  for (std::size_t i = 0; i < values.size(); ++i) {
    groups[group_of(i)].add(values[i]);
  }
  return groups;
}

/// Standard deviation of constants of groups with zero mean; fails where the error is not constant within them.
double deviation_between(const std::map<int, Statistics>& groups) {
  double squares = 0.0;
  for (const auto& [group, statistics] : groups) {
    EXPECT_LT(statistics.deviation(), 1e-6) << group;
    squares += statistics.mean() * statistics.mean();
  }
  return std::sqrt(squares / static_cast<double>(groups.size()));
}

/// Four standard errors of a standard deviation of n numbers.
double deviation_error(double sigma, double n) { return 4.0 * sigma / std::sqrt(2.0 * n); }

/// Least squares slope of the errors over `regressor`; the fit must leave no more than `remainder`.
double fitted_slope(const SimulatedScan& scan, const std::function<double(std::size_t)>& regressor, double remainder) {
  const std::vector<double> values = errors(scan);
  double xx = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    xx += regressor(i) * regressor(i);
    xy += regressor(i) * values[i];
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_LT(std::abs(values[i] - xy / xx * regressor(i)), remainder);
  }
  return xy / xx;
}

TEST(DopplerError, LinesBeamsAndFacesHaveConstantsOfTheirOwn) {
  Room room;
  room.config.columns = 60;
  room.config.rows = 600;
  room.config.doppler_error.line_mps = 0.05;
  const SimulatedScan lines = room.scan(scan_pattern(room.config));
  EXPECT_NEAR(deviation_between(grouped(lines, [&](std::size_t i) { return lines.lines[i]; })), 0.05,
              deviation_error(0.05, 600.0));
  room.config.doppler_error.line_mps = 0.0;
  room.config.beams = 4;
  room.config.doppler_error.beam_mps = 0.1;
  const SimulatedScan beams = room.scan(scan_pattern(room.config));
  const auto by_beam = grouped(beams, [&](std::size_t i) { return beams.lines[i] % 4; });
  EXPECT_EQ(by_beam.size(), 4U);
  EXPECT_NEAR(deviation_between(by_beam), 0.1, deviation_error(0.1, 4.0));
  EXPECT_NE(by_beam.at(0).mean(), by_beam.at(1).mean());
  room.config.doppler_error.beam_mps = 0.0;
  room.config.faces = 6;
  room.config.doppler_error.face_mps = 0.1;
  const SimulatedScan faces = room.scan(scan_pattern(room.config));
  const auto by_face = grouped(faces, [&](std::size_t i) { return faces.faces[i]; });
  EXPECT_EQ(by_face.size(), 6U);
  EXPECT_NEAR(deviation_between(by_face), 0.1, deviation_error(0.1, 6.0));
}

TEST(DopplerError, FacesSweepPartsOfTheAzimuthOrWholeScans) {
  Room room;
  room.config.faces = 3;
  room.config.doppler_error.face_mps = 0.1;
  const SimulatedScan parts = room.scan(scan_pattern(room.config));
  for (std::size_t i = 0; i < parts.bodies.size(); ++i) {
    const Vector3d& p = parts.measured.points[i];
    EXPECT_EQ(parts.faces[i], std::floor((60.0 - 180.0 / std::numbers::pi * std::atan2(p.y(), p.x())) / 40.0));
  }
  room.config.face_per_scan = true;
  const ScanPattern pattern = scan_pattern(room.config);
  std::map<std::size_t, double> means;
  for (std::size_t index = 0; index < 6; ++index) {
    const SimulatedScan scan = simulate_scan({room.world, *room.caster, room.sensor}, pattern, SensorUnit(room.config),
                                             {Stamp{}, index}, RandomSource(9), Workers(1));
    const auto face = grouped(scan, [&](std::size_t i) { return scan.faces[i]; });
    ASSERT_EQ(face.size(), 1U);
    EXPECT_EQ(static_cast<std::size_t>(face.begin()->first), index % 3);
    const auto [known, is_new] = means.try_emplace(index % 3, face.begin()->second.mean());
    EXPECT_NEAR(known->second, face.begin()->second.mean(), 1e-12);
    EXPECT_EQ(is_new, index < 3);
  }
}

TEST(DopplerError, SensorsAndUnitsDifferAndStayTheSame) {
  FmcwLidarConfig lidar;
  lidar.doppler_error.sensor_mps = 0.1;
  Statistics values;
  for (int unit = 0; unit < 2000; ++unit) {
    lidar.unit = unit;
    values.add(SensorUnit(lidar, "left").doppler.systematic_mps({}));
  }
  EXPECT_NEAR(values.mean(), 0.0, 4.0 * 0.1 / std::sqrt(2000.0));
  EXPECT_NEAR(values.deviation(), 0.1, deviation_error(0.1, 2000.0));
  const double left = SensorUnit(lidar, "left").doppler.systematic_mps({});
  EXPECT_EQ(SensorUnit(lidar, "left").doppler.systematic_mps({}), left);
  EXPECT_NE(SensorUnit(lidar, "right").doppler.systematic_mps({}), left);
}

TEST(DopplerError, FieldOfDirectionsIsSmoothAndHasItsSize) {
  Room room;
  room.config.columns = 240;
  room.config.rows = 32;
  room.config.doppler_error.direction_mps = 0.15;
  const ScanPattern pattern = scan_pattern(room.config);
  const SimulatedScan scan = room.scan(pattern);
  const std::vector<double> values = errors(scan);
  ASSERT_EQ(values.size(), 240U * 32U);
  Statistics all;
  for (std::size_t i = 0; i < values.size(); ++i) {
    all.add(values[i]);
    if (i >= 32) {
      EXPECT_LT(std::abs(values[i] - values[i - 32]), 0.02) << "half a degree aside";
    }
  }
  EXPECT_NEAR(all.mean(), 0.0, 1e-3);
  EXPECT_NEAR(all.deviation(), 0.15, 1e-3);
}

TEST(DopplerError, RangeIncidenceIntensityAndScaleAreSlopes) {
  Room room;
  room.config.max_range_m = 100.0;
  const ScanPattern pattern = scan_pattern(room.config);
  const auto measured = [&](double DopplerErrorConfig::*setting, double value) {
    room.config.doppler_error = {};
    room.config.doppler_error.*setting = value;
    return room.scan(pattern);
  };
  const SimulatedScan by_range = measured(&DopplerErrorConfig::range_mps_per_100m, 0.07);
  EXPECT_NEAR(fitted_slope(
                  by_range, [&](std::size_t i) { return by_range.true_range[i] / 100.0; }, 1e-12),
              0.07, 1e-9);
  const SimulatedScan near = measured(&DopplerErrorConfig::near_mps, -0.1);
  EXPECT_NEAR(fitted_slope(
                  near, [&](std::size_t i) { return std::exp(-near.true_range[i] / 10.0); }, 1e-12),
              -0.1, 1e-9);
  const SimulatedScan scale = measured(&DopplerErrorConfig::scale, 0.001);
  EXPECT_NEAR(fitted_slope(
                  scale, [&](std::size_t i) { return scale.true_doppler[i]; }, 1e-12),
              0.001, 1e-9);
  const SimulatedScan power = measured(&DopplerErrorConfig::intensity_mps_per_10db, 0.03);
  EXPECT_NEAR(fitted_slope(
                  power, [&](std::size_t i) { return (power.intensity_db[i] + 30.0) / 10.0; }, 1e-6),
              0.03, 1e-6);
}

TEST(DopplerError, IncidenceCounts) {
  for (const double slant_deg : {0.0, 40.0, 60.0}) {
    Wall wall(100.0, 0.3, slant_deg);
    wall.config.horizontal_fov_deg = 1.0;
    wall.config.doppler_error.incidence_mps = 0.05;
    Statistics statistics;
    for (const double error : errors(wall.scan())) {
      statistics.add(error);
    }
    EXPECT_NEAR(statistics.mean(), 0.05 * (1.0 - std::cos(slant_deg * std::numbers::pi / 180.0)), 1e-4);
  }
}

TEST(DopplerError, NoiseOfScansAndFiringsIsCommonToThem) {
  Room room;
  room.config.columns = 900;
  room.config.sweep_s = 0.1;
  room.config.doppler_error.firing_noise_mps = 0.05;
  const SimulatedScan firings = room.scan(scan_pattern(room.config));
  const auto by_firing = grouped(
      firings, [&](std::size_t i) { return static_cast<int>(std::lround(9000.0 * firings.measured.times[i])); });
  ASSERT_EQ(by_firing.size(), 900U);
  EXPECT_NEAR(deviation_between(by_firing), 0.05, deviation_error(0.05, 900.0));

  room.config.columns = 2;
  room.config.doppler_error = {};
  room.config.doppler_error.scan_noise_mps = 0.05;
  const ScanPattern pattern = scan_pattern(room.config);
  Statistics scans;
  for (std::uint64_t index = 0; index < 400; ++index) {
    const SimulatedScan scan = simulate_scan({room.world, *room.caster, room.sensor}, pattern, SensorUnit(room.config),
                                             {Stamp{}}, RandomSource(9).fork(index), Workers(1));
    const auto one = grouped(scan, [](std::size_t) { return 0; });
    EXPECT_LT(one.at(0).deviation(), 1e-8);
    scans.add(one.at(0).mean());
  }
  EXPECT_NEAR(scans.deviation(), 0.05, deviation_error(0.05, 400.0));
}

TEST(DopplerError, RestartBringsAnotherConstant) {
  Room room;
  room.config.sweep_s = 0.1;
  room.config.doppler_error.restart_s = 0.35;  // the scan begins at 0.3 s
  room.config.doppler_error.restart_mps = 0.2;
  const SimulatedScan scan = room.scan(scan_pattern(room.config));
  const std::vector<double> values = errors(scan);
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(values[i], scan.measured.times[i] < 0.05 - 1e-9 ? 0.0 : 0.2, 1e-12);
  }
}

TEST(DopplerError, DriftIsARandomWalk) {
  DopplerErrorConfig config;
  config.drift_mps_per_sqrt_s = 0.02;
  const DopplerError error(config, {}, RandomSource(1));
  Statistics steps, after;
  for (std::uint64_t drive = 0; drive < 400; ++drive) {
    const RandomSource random(drive);
    EXPECT_EQ(error.drift_mps(0, 0.1, random), 0.0);
    after.add(error.drift_mps(90, 0.1, random));
    steps.add(error.drift_mps(31, 0.1, random) - error.drift_mps(30, 0.1, random));
  }
  EXPECT_NEAR(after.deviation(), 0.02 * 3.0, deviation_error(0.06, 400.0));  // after 9 s
  EXPECT_NEAR(steps.deviation(), 0.02 * std::sqrt(0.1), deviation_error(0.0064, 400.0));
}

TEST(DopplerError, NoiseGrowsWithRangeAndFallsWithPower) {
  Wall wall(150.1, 0.1);
  wall.config.detection_range_m = 300.0;
  wall.config.doppler_noise_mps = 0.03;
  wall.config.doppler_error.noise_mps_per_100m = 0.04;
  wall.config.doppler_error.weak_noise_mps = 0.1;
  Statistics statistics;
  for (const double error : errors(wall.scan())) {
    statistics.add(error);
  }
  // Half the range of detection: four times the power, half of the noise.
  const double sigma = std::sqrt(0.03 * 0.03 + 0.06 * 0.06 + 0.05 * 0.05);
  EXPECT_NEAR(statistics.deviation(), sigma, deviation_error(sigma, statistics.n));
}

TEST(DopplerError, VelocitiesBeyondTheAmbiguityWrap) {
  Room room;
  room.config.doppler_error.ambiguity_mps = 3.0;
  const SimulatedScan scan = room.scan(scan_pattern(room.config));
  int wraps = 0;
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    EXPECT_TRUE(scan.measured.doppler[i] >= -3.0 && scan.measured.doppler[i] < 3.0);
    const double turns = (scan.true_doppler[i] - scan.measured.doppler[i]) / 6.0;
    EXPECT_NEAR(turns, std::round(turns), 1e-9);
    wraps += std::abs(turns) > 0.5 ? 1 : 0;
  }
  EXPECT_GT(wraps, 100);
}

TEST(DopplerError, SystematicPartIsWhatIsLeftWithoutNoise) {
  Room room;
  room.config.doppler_bias_mps = 0.1;
  room.config.doppler_error.line_mps = 0.05;
  room.config.doppler_error.direction_mps = 0.1;
  room.config.doppler_error.scale = 0.01;
  const SimulatedScan scan = room.scan(scan_pattern(room.config));
  const std::vector<double> values = errors(scan);
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(scan.systematic_error[i], values[i], 1e-12);
  }
  DopplerErrorConfig none;
  none.ambiguity_mps = 50.0;
  none.firing_noise_mps = 0.1;
  EXPECT_FALSE(has_systematic_error(none));
  none.near_mps = 0.1;
  EXPECT_TRUE(has_systematic_error(none));
}

}  // namespace
}  // namespace dynamic_icp::simulation
