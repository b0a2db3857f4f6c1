// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/expected_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

#include "testing/tracked_car.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

/// What is expected of a body that drives with `velocity` and was seen from its rear.
Expectation expected_body(const Vector3d& centre, const Vector3d& velocity, const SensorMotion& sensor) {
  const Track track = track_of_car(centre, velocity);
  return {track, track.estimate(), sensor, {}};
}

/// Rows in the order of a sensor that looks around once, near far and high low, with the radial velocities of the
/// bodies.
struct Sweep {
  Scan scan;
  std::vector<double> radial;
};

Sweep sweep(bool has_times, const std::vector<Expectation>& bodies, const SensorMotion& sensor) {
  constexpr std::size_t kPoints = 30001;
  RawScan raw;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const RandomSource one = RandomSource(8).fork(i);
    const double azimuth = std::numbers::pi * (2.0 * static_cast<double>(i) / kPoints - 1.0);
    const double range = 18.0 + 2.0 * std::round(1.4 * std::sin(100.0 * azimuth)) + one.uniform(0, -1.0, 1.0);
    raw.points.emplace_back(range * std::cos(azimuth), range * std::sin(azimuth), one.uniform(1, -1.2, 1.2));
    raw.doppler.push_back(0.0);
    if (has_times) {
      raw.times.push_back(0.1 * static_cast<double>(i) / kPoints - 0.03);
    }
  }
  Sweep result{Scan::from_raw(raw), {}};
  for (std::size_t i = 0; i < result.scan.size(); ++i) {
    const Vector3d u = sensor.direction_world(result.scan.directions()[i], has_times ? result.scan.times()[i] : 0.0);
    const double of_body = i % 2 == 0 ? 0.0 : u.dot(bodies[i / 2 % bodies.size()].W);
    result.radial.push_back(of_body);
  }
  return result;
}

/// Row by row, as it is defined.
std::vector<std::uint8_t> flagged_one_by_one(const Sweep& input, const SensorMotion& sensor,
                                             const std::vector<Expectation>& bodies,
                                             std::vector<std::uint8_t> is_moving) {
  for (const Expectation& body : bodies) {
    OrientedBox box = body.box;
    const double clearance = std::min(0.3, 0.25 * box.size.z());
    box.size += Vector3d(2.0 * body.gate_m, 2.0 * body.gate_m, body.gate_m - clearance);
    box.centre += 0.5 * (body.gate_m + clearance) * box.axes.col(2);
    for (std::size_t i = 0; i < input.scan.size(); ++i) {
      const double time = input.scan.has_times() ? input.scan.times()[i] : 0.0;
      const Vector3d then = sensor.point_world(input.scan.points()[i], time);
      const bool is_inside = distance_outside(box, then - time * body.velocity) <= 0.0;
      const Vector3d u = sensor.direction_world(input.scan.directions()[i], time);
      if (is_inside && body.gate_ratio(u, input.radial[i]) < 1.0) {
        is_moving[i] = 1;
      }
    }
  }
  return is_moving;
}

TEST(ExpectedRows, AreThoseInTheBoxesWithTheExpectedVelocityWhileTheSensorMovesAndTurns) {
  SensorMotion sensor;
  sensor.T_world_sensor.rotate(Eigen::AngleAxisd(0.7, Vector3d(0.01, -0.02, 1.0).normalized()));
  sensor.T_world_sensor.pretranslate(Vector3d(3.0, -4.0, 0.5));
  sensor.velocity_world = Vector3d(12.0, 5.0, 0.3);
  sensor.angular_velocity_sensor = Vector3d(0.1, -0.2, 1.5);
  std::vector<Expectation> bodies;
  for (const double azimuth : {0.4, 1.9, -2.2}) {
    bodies.push_back(expected_body({3.0 + 18.0 * std::cos(azimuth), -4.0 + 18.0 * std::sin(azimuth), 0.5},
                                   {-30.0 * std::sin(azimuth), 9.0, 0.0}, sensor));
  }
  for (const bool has_times : {false, true}) {
    const Sweep input = sweep(has_times, bodies, sensor);
    std::vector<std::uint8_t> before(input.scan.size(), 0);
    for (std::size_t i = 0; i < before.size(); i += 7) {
      before[i] = 1;
    }
    const std::vector<std::uint8_t> expected = flagged_one_by_one(input, sensor, bodies, before);
    const auto count = [](const std::vector<std::uint8_t>& flags) {
      return std::accumulate(flags.begin(), flags.end(), 0);
    };
    ASSERT_GT(count(expected), count(before) + 100);
    for (const int threads : {1, 2}) {
      std::vector<std::uint8_t> flags = before;
      ScanPatches patches;
      patches.bound(input.scan, Workers(threads));
      flag_rows(input.scan, patches, input.radial, sensor, bodies, Workers(threads), flags);
      EXPECT_EQ(flags, expected) << has_times << ", threads: " << threads;
    }
  }
}

TEST(ExpectedRows, WithoutExpectationsNothingIsFlagged) {
  const Sweep input = sweep(true, {expected_body({18.0, 0.0, 0.0}, {9.0, 0.0, 0.0}, {})}, {});
  std::vector<std::uint8_t> flags(input.scan.size(), 0);
  flag_rows(input.scan, {}, input.radial, {}, {}, Workers(1), flags);
  EXPECT_EQ(std::count(flags.begin(), flags.end(), 1), 0);
}

TEST(ExpectedRows, StaticOnesAreThoseInTheBoxAboveTheGround) {
  const Vector3d centre(20.0, 3.0, 0.0);
  const Expectation expected = expected_body(centre, {0.0, 8.0, 0.0}, {});
  ASSERT_GT(expected.box.size.z(), 1.0);
  RawScan raw;
  std::set<std::uint32_t> inside;
  std::vector<std::uint8_t> is_moving;
  const RandomSource random(9);
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const RandomSource one = random.fork(i);
    const Vector3d p = centre + Vector3d(one.uniform(0, -5, 5), one.uniform(1, -5, 5), one.uniform(2, -1.5, 1.5));
    raw.points.push_back(p);
    raw.doppler.push_back(0.0);
    is_moving.push_back(one.uniform(3) < 0.3 ? 1 : 0);
    const Vector3d q = expected.box.axes.transpose() * (p - expected.box.centre);
    const double above = q.z() + 0.5 * expected.box.size.z();
    const bool in_box = (q.cwiseAbs().array() <= 0.5 * expected.box.size.array()).all();
    if (in_box && above >= std::min(0.3, 0.25 * expected.box.size.z()) && is_moving.back() == 0) {
      inside.insert(i);
    }
  }
  ASSERT_GT(inside.size(), 20u);
  const Scan scan = Scan::from_raw(raw);
  ASSERT_EQ(scan.size(), raw.points.size());
  const std::vector<double> radial(scan.size(), 0.0);
  for (const int threads : {1, 2}) {
    const Workers workers(threads);
    const RangeImage view(scan, Vector3d::Zero(), workers);
    ScanPatches patches;
    patches.bound(scan, workers);
    const MovingCells moving;
    const GroundHeights heights;
    const TrackingInput input{scan, radial, is_moving, {}, 0.0, moving, {}, {}, {}, view, heights, patches};
    std::vector<std::uint32_t> visited{77};
    find_static_rows(input, expected, visited);
    EXPECT_TRUE(std::is_sorted(visited.begin(), visited.end()));
    EXPECT_EQ(std::set<std::uint32_t>(visited.begin(), visited.end()), inside);
    EXPECT_EQ(visited.size(), inside.size()) << "none twice";
  }
}

}  // namespace
}  // namespace dynamic_icp::tracking
