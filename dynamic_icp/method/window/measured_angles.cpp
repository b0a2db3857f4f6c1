// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/measured_angles.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace dynamic_icp::window {
namespace {

constexpr double kNearAxis_m = 1e-3;

Eigen::Vector3d in_sensor(const Scan& scan, std::size_t row) {
  const Eigen::Vector3d& point = scan.points()[row];
  return scan.is_of_rig() ? Eigen::Vector3d(scan.mountings()[scan.channels().sensor[row]].inverse() * point) : point;
}

}  // namespace

Eigen::Matrix<double, 3, 2> by_angles(const Scan& scan, std::size_t row) {
  const Eigen::Vector3d x = in_sensor(scan, row);
  const double across = std::max(kNearAxis_m, std::hypot(x.x(), x.y()));
  Eigen::Matrix<double, 3, 2> J;
  J.col(0) << -x.y(), x.x(), 0.0;
  J.col(1) << -x.z() * x.x() / across, -x.z() * x.y() / across, across;
  return scan.is_of_rig() ? (scan.mountings()[scan.channels().sensor[row]].linear() * J).eval() : J;
}

}  // namespace dynamic_icp::window
