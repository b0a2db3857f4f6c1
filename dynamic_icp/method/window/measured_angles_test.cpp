// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/measured_angles.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace dynamic_icp::window {
namespace {

using Eigen::Vector3d;

Vector3d at(double azimuth, double elevation) {
  return 12.0 * Vector3d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                         std::sin(elevation));
}

Eigen::Isometry3d mounting() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(1.2, Vector3d(1.0, 0.5, -0.3).normalized()).toRotationMatrix();
  T.translation() = Vector3d(1.0, -0.5, 0.4);
  return T;
}

TEST(MeasuredAngles, DerivativesAreThoseOfDifferences) {
  for (const bool is_of_rig : {false, true}) {
    const Eigen::Isometry3d T = is_of_rig ? mounting() : Eigen::Isometry3d::Identity();
    for (const double azimuth : {-2.0, 0.3, 1.4}) {
      for (const double elevation : {-0.4, 0.0, 0.7}) {
        RawScan raw;
        raw.points.push_back(T * at(azimuth, elevation));
        raw.doppler.push_back(0.0);
        if (is_of_rig) {
          raw.channels.sensor.push_back(0);
          raw.mountings = {T};
        }
        const Scan scan = Scan::from_raw(raw);
        const Eigen::Matrix<double, 3, 2> J = by_angles(scan, 0);
        constexpr double kStep = 1e-5;
        const Vector3d by_azimuth = (at(azimuth + kStep, elevation) - at(azimuth - kStep, elevation)) / (2.0 * kStep);
        const Vector3d by_elevation = (at(azimuth, elevation + kStep) - at(azimuth, elevation - kStep)) / (2.0 * kStep);
        EXPECT_LT((J.col(0) - T.linear() * by_azimuth).norm(), 1e-6);
        EXPECT_LT((J.col(1) - T.linear() * by_elevation).norm(), 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::window
