// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>

#include <gtest/gtest.h>

#include "dynamic_icp/method/window/plane_terms.hpp"

#include "testing/one_thread.hpp"
#include "testing/swept_room.hpp"

namespace dynamic_icp::window {
namespace {

using Eigen::Vector3d;

constexpr double kScanKnots_s = 0.0125;
constexpr double kScanSlice_s = kScanKnots_s / 8.0;

/// A scan in an instant by a sensor that stands, all of whose points are turned by [azimuth; elevation] (rad).
Scan turned_scan(const Room& room, const Eigen::Vector2d& error) {
  RawScan raw;
  for (const Vector3d& x : room.points(3, 6000)) {
    const double azimuth = std::atan2(x.y(), x.x()) + error.x();
    const double elevation = std::atan2(x.z(), std::hypot(x.x(), x.y())) + error.y();
    raw.points.push_back(x.norm() * Vector3d(std::cos(elevation) * std::cos(azimuth),
                                             std::cos(elevation) * std::sin(azimuth), std::sin(elevation)));
    raw.doppler.push_back(0.0);
  }
  return Scan::from_raw(raw);
}

TEST(ScanPointing, FindsWhereAWholeScanPoints) {
  const Room room;
  const mapping::PlaneMap map = room.map();
  const Eigen::Vector2d error(4e-4, -6e-4);
  const Scan scan = turned_scan(room, error);
  SplineTrajectory trajectory(kScanKnots_s);
  trajectory.begin(0.0, kScanKnots_s, Eigen::Isometry3d::Identity(), Vector3d::Zero(), Vector3d::Zero());
  const Layout layout{0, static_cast<Eigen::Index>(trajectory.coefficients().size()), false};
  PlaneTerms terms(scan, map, 0.0, kScanSlice_s, kOneThread);
  const auto gradient = [&](double variance) {
    PlaneNoise noise;
    noise.pointing_variance.setConstant(variance);
    terms.associate(trajectory, Eigen::VectorXd::Zero(Layout::kMapError), noise, false);
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(layout.size(), layout.size());
    Eigen::VectorXd g = Eigen::VectorXd::Zero(layout.size());
    terms.add(layout, H, g);
    return g.segment(layout.coefficient(0), 6 * layout.coefficients).eval();
  };
  const double without = gradient(0.0).norm();
  EXPECT_LT(terms.scan_pointing(layout).error.cwiseAbs().maxCoeff(), 1e-8) << "there is no room for it";
  const double with = gradient(1e-4).norm();
  EXPECT_LT(with, 0.1 * without) << "the sensor stands where it stood: nothing pulls";
  const PlaneTerms::ScanPointing found = terms.scan_pointing(layout);
  for (const Eigen::Index k : {0, 1}) {
    EXPECT_NEAR(found.error[k], error[k], 4.0 * std::sqrt(found.variance[k])) << k;
    EXPECT_LT(std::sqrt(found.variance[k]), 1e-4) << k;
  }
}

}  // namespace
}  // namespace dynamic_icp::window
