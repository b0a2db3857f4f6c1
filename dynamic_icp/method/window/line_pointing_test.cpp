// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/line_pointing.hpp"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "testing/one_thread.hpp"
#include "testing/swept_room.hpp"

namespace dynamic_icp::window {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::size_t kSensorLines = 8;
constexpr double kLineKnots_s = 0.0125;
constexpr std::array<double, kSensorLines> kAzimuth_rad = {1e-3, -4e-4, 7e-4, -1.1e-3, 3e-4, -8e-4, 2e-4, 1e-4};
constexpr std::array<double, kSensorLines> kElevation_rad = {-6e-4, 9e-4, 1e-4, -2e-4, -1e-3, 5e-4, 8e-4, -5e-4};

/// The point at the same range whose azimuth and elevation are larger by an error.
Vector3d turned(const Vector3d& x, const Vector2d& error) {
  const double azimuth = std::atan2(x.y(), x.x()) + error.x();
  const double elevation = std::atan2(x.z(), std::hypot(x.x(), x.y())) + error.y();
  return x.norm() * Vector3d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                             std::sin(elevation));
}

/// A scan in an instant by a sensor that stands in the middle of a room, its points on lines at random.
RawScan scan_of(const Room& room, unsigned seed, double share_of_errors) {
  RawScan raw;
  for (const Vector3d& x : room.points(seed, 6000)) {
    const std::size_t line = raw.points.size() * 5 % kSensorLines;
    raw.points.push_back(turned(x, share_of_errors * Vector2d(kAzimuth_rad[line], kElevation_rad[line])));
    raw.doppler.push_back(0.0);
    raw.channels.line.push_back(static_cast<std::uint16_t>(line));
  }
  return raw;
}

SplineTrajectory standing() {
  SplineTrajectory trajectory(kLineKnots_s);
  trajectory.begin(0.0, kLineKnots_s, Eigen::Isometry3d::Identity(), Vector3d::Zero(), Vector3d::Zero());
  return trajectory;
}

Scan learn_from(const Scan& scan, const mapping::PlaneMap& map, LinePointing& pointing) {
  Scan corrected = scan;
  pointing.correct(corrected);
  PlaneTerms planes(corrected, map, 0.0, kLineKnots_s, kOneThread);
  planes.associate(standing(), Eigen::VectorXd::Zero(Layout::kMapError), {}, false);
  pointing.learn(planes);
  return corrected;
}

TEST(LinePointing, FindsTheErrorOfEachLine) {
  const Room room;
  const mapping::PlaneMap map = room.map();
  LinePointing pointing;
  Scan scan;
  for (unsigned k = 0; k < 16; ++k) {
    scan = Scan::from_raw(scan_of(room, 10 + k, 1.0));
    learn_from(scan, map, pointing);
  }
  // 750 points a line with 5 mm, half of which hold an angle at 7 m: 0.04 mrad a scan. The first scans tell too little:
  // robust weights take their errors of pointing for outliers. What they said counts less with each scan.
  for (std::size_t row = 0; row < kSensorLines; ++row) {
    const std::size_t line = scan.channels().line[row];
    EXPECT_NEAR(pointing.error(row).x(), kAzimuth_rad[line], 8e-5) << line;
    EXPECT_NEAR(pointing.error(row).y(), kElevation_rad[line], 8e-5) << line;
  }
  EXPECT_NEAR(pointing.sigma_rad(), 6.5e-4, 2e-4);
}

TEST(LinePointing, LearnsNothingOfPointsThatItDidNotSee) {
  const Room room;
  const mapping::PlaneMap map = room.map();
  const Scan scan = Scan::from_raw(scan_of(room, 10, 1.0));
  PlaneTerms planes(scan, map, 0.0, kLineKnots_s, kOneThread);
  planes.associate(standing(), Eigen::VectorXd::Zero(Layout::kMapError), {}, false);
  LinePointing pointing;
  const double before = pointing.sigma_rad();
  pointing.learn(planes);
  EXPECT_EQ(pointing.sigma_rad(), before);
}

TEST(LinePointing, TakesTheErrorsOutOfThePoints) {
  const Room room;
  const mapping::PlaneMap map = room.map();
  LinePointing pointing;
  for (unsigned k = 0; k < 8; ++k) {
    learn_from(Scan::from_raw(scan_of(room, 10 + k, 1.0)), map, pointing);
  }
  const Scan exact = Scan::from_raw(scan_of(room, 40, 0.0));
  Scan corrected = Scan::from_raw(scan_of(room, 40, 1.0));
  const Scan measured = corrected;
  pointing.correct(corrected);
  double before = 0.0;
  double after = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    before += (measured.points()[i] - exact.points()[i]).squaredNorm();
    after += (corrected.points()[i] - exact.points()[i]).squaredNorm();
  }
  EXPECT_LT(after, 0.02 * before);
}

TEST(LinePointing, FindsNothingWhereNothingIs) {
  const Room room;
  const mapping::PlaneMap map = room.map();
  LinePointing pointing;
  for (unsigned k = 0; k < 8; ++k) {
    learn_from(Scan::from_raw(scan_of(room, 10 + k, 0.0)), map, pointing);
  }
  for (std::size_t row = 0; row < kSensorLines; ++row) {
    EXPECT_LT(pointing.error(row).norm(), 8e-5);
  }
}

// The lines of a sensor of a rig are about its own axes.
TEST(LinePointing, KnowsWhereTheSensorsOfARigSit) {
  const Room room;
  const mapping::PlaneMap map = room.map();
  Eigen::Isometry3d mounting = Eigen::Isometry3d::Identity();
  mounting.linear() = Eigen::AngleAxisd(1.2, Vector3d(1.0, 0.5, -0.3).normalized()).toRotationMatrix();
  mounting.translation() = Vector3d(1.0, -0.5, 0.4);
  LinePointing pointing;
  Scan scan;
  for (unsigned k = 0; k < 8; ++k) {
    RawScan raw;
    for (const Vector3d& seen : room.points(10 + k, 6000)) {
      const std::size_t line = raw.points.size() * 5 % kSensorLines;
      raw.points.push_back(mounting *
                           turned(mounting.inverse() * seen, Vector2d(kAzimuth_rad[line], kElevation_rad[line])));
      raw.doppler.push_back(0.0);
      raw.channels.line.push_back(static_cast<std::uint16_t>(line));
      raw.channels.sensor.push_back(0);
    }
    raw.mountings = {mounting};
    scan = Scan::from_raw(raw);
    learn_from(scan, map, pointing);
  }
  for (std::size_t row = 0; row < kSensorLines; ++row) {
    const std::size_t line = scan.channels().line[row];
    EXPECT_NEAR(pointing.error(row).x(), kAzimuth_rad[line], 1e-4) << line;
    EXPECT_NEAR(pointing.error(row).y(), kElevation_rad[line], 1e-4) << line;
  }
}

}  // namespace
}  // namespace dynamic_icp::window
