// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/line_pointing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace dynamic_icp::window {
namespace {

// Lines of a sensor that does not tell them: steps of elevation.
constexpr double kElevationStep_rad = 0.1 * std::numbers::pi / 180.0;

// What the planes say of a line is of a map that was made with other errors of its lines: it fades from scan to scan.
constexpr double kPlaneMemory = 0.97;

constexpr double kNearAxis_m = 1e-3;

/// A point in the axes of its sensor.
struct InSensor {
  Eigen::Matrix3d R_scan_sensor = Eigen::Matrix3d::Identity();
  Eigen::Vector3d x = Eigen::Vector3d::Zero();  ///< m, sensor axes
};

InSensor in_sensor(const Scan& scan, std::size_t row) {
  if (!scan.is_of_rig()) {
    return {Eigen::Matrix3d::Identity(), scan.points()[row]};
  }
  const Eigen::Isometry3d& T_scan_sensor = scan.mountings()[scan.channels().sensor[row]];
  return {T_scan_sensor.linear(), T_scan_sensor.inverse() * scan.points()[row]};
}

/// How a point moves with azimuth and elevation, m/rad, axes of the scan.
Eigen::Matrix<double, 3, 2> by_angles(const InSensor& point) {
  const Eigen::Vector3d& x = point.x;
  const double across = std::max(kNearAxis_m, std::hypot(x.x(), x.y()));
  Eigen::Matrix<double, 3, 2> J;
  J.col(0) << -x.y(), x.x(), 0.0;
  J.col(1) << -x.z() * x.x() / across, -x.z() * x.y() / across, across;
  return point.R_scan_sensor * J;
}

std::uint32_t line_of(const Scan& scan, std::size_t row, const Eigen::Vector3d& x) {
  const std::uint32_t sensor = scan.channels().sensor.empty() ? 0 : scan.channels().sensor[row];
  const std::vector<std::uint16_t>& lines = scan.channels().line;
  const double step = (std::atan2(x.z(), std::hypot(x.x(), x.y())) + 0.5 * std::numbers::pi) / kElevationStep_rad;
  return (sensor << 16U) | (lines.empty() ? static_cast<std::uint32_t>(step) : lines[row]);
}

}  // namespace

LinePointing::LinePointing() : variance_({.sigma = 2e-4, .counts = 8.0, .min_sigma = 1e-6, .max_sigma = 3e-3}) {}

double LinePointing::sigma_rad() const { return std::sqrt(variance_.value()); }

void LinePointing::correct(Scan& points) {
  line_of_row_.resize(points.size());
  for (std::size_t row = 0; row < points.size(); ++row) {
    const InSensor point = in_sensor(points, row);
    Line& line = lines_[line_of(points, row, point.x)];
    line_of_row_[row] = &line;
    points.displace(row, -by_angles(point) * line.error);
  }
}

void LinePointing::learn(const Scan& points, const PlaneTerms& planes) {
  for (auto& [key, line] : lines_) {
    line.information *= kPlaneMemory;
    line.weighted *= kPlaneMemory;
  }
  for (const PlaneTerms::Residual& residual : planes.residuals()) {
    Line& line = *line_of_row_[residual.row];
    const Eigen::Vector2d J = by_angles(in_sensor(points, residual.row)).transpose() * residual.normal_sensor;
    line.information += residual.w * J * J.transpose();
    line.weighted += residual.w * (residual.e + J.dot(line.error)) * J;
  }
  const double prior = variance_.value();
  double squares = 0.0;
  double known = 0.0;
  for (auto& [key, line] : lines_) {
    const Eigen::Matrix2d covariance = (line.information + Eigen::Matrix2d::Identity() / prior).inverse();
    line.error = covariance * line.weighted;
    squares += line.error.squaredNorm();
    known += std::max(0.0, 2.0 - covariance.trace() / prior);
  }
  variance_.update(squares, known);
  variance_.keep();
}

}  // namespace dynamic_icp::window
