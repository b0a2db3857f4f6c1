// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/line_pointing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "dynamic_icp/method/window/measured_angles.hpp"

namespace dynamic_icp::window {
namespace {

// Lines of a sensor that does not tell them: steps of elevation.
constexpr double kElevationStep_rad = 0.1 * std::numbers::pi / 180.0;

// What the planes say of a line is of a map that was made with other errors of its lines: it fades from scan to scan.
constexpr double kPlaneMemory = 0.97;

std::uint32_t line_of(const Scan& scan, std::size_t row) {
  const std::uint32_t sensor = scan.channels().sensor.empty() ? 0 : scan.channels().sensor[row];
  const std::vector<std::uint16_t>& lines = scan.channels().line;
  const double step = (measured_elevation(scan, row) + 0.5 * std::numbers::pi) / kElevationStep_rad;
  return (sensor << 16U) | (lines.empty() ? static_cast<std::uint32_t>(step) : lines[row]);
}

}  // namespace

LinePointing::LinePointing() : variance_({.sigma = 2e-4, .counts = 8.0, .min_sigma = 1e-6, .max_sigma = 3e-3}) {}

double LinePointing::sigma_rad() const { return std::sqrt(variance_.value()); }

void LinePointing::correct(Scan& points) {
  line_of_row_.resize(points.size());
  for (std::size_t row = 0; row < points.size(); ++row) {
    const auto [number, is_new] = numbers_.try_emplace(line_of(points, row), lines_.size());
    if (is_new) {
      lines_.emplace_back();
    }
    line_of_row_[row] = number->second;
    points.displace(row, -by_angles(points, row) * lines_[number->second].error);
  }
}

void LinePointing::learn(const PlaneTerms& planes) {
  if (line_of_row_.empty()) {
    return;
  }
  for (Line& line : lines_) {
    line.information *= kPlaneMemory;
    line.weighted *= kPlaneMemory;
  }
  for (const PlaneTerms::Residual& residual : planes.residuals()) {
    Line& line = lines_[line_of_row_[residual.row]];
    line.information += residual.w * residual.J * residual.J.transpose();
    line.weighted += residual.w * (residual.e + residual.J.dot(line.error)) * residual.J;
  }
  const double prior = variance_.value();
  double squares = 0.0;
  double known = 0.0;
  for (Line& line : lines_) {
    const Eigen::Matrix2d covariance = (line.information + Eigen::Matrix2d::Identity() / prior).inverse();
    line.error = covariance * line.weighted;
    squares += line.error.squaredNorm();
    known += std::max(0.0, 2.0 - covariance.trace() / prior);
  }
  variance_.update(squares, known);
  variance_.keep();
}

}  // namespace dynamic_icp::window
