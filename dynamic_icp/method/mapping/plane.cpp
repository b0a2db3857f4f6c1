// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/mapping/plane.hpp"

#include <algorithm>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace dynamic_icp::mapping {
namespace {

// A plane has three parameters: that many residuals are lost to it.
constexpr double kParameters = 3.0;

/// Mean square of the points around their mean, m^2.
Eigen::Matrix3d scatter_around(const Eigen::Vector3d& mean, const Moments& moments) {
  const Eigen::Matrix<double, 6, 1> m = moments.second / moments.weight;
  Eigen::Matrix3d scatter;
  scatter << m[0], m[1], m[2], m[1], m[3], m[4], m[2], m[4], m[5];
  return scatter - mean * mean.transpose();
}

/// Pseudo-inverse of what the scatter is within a plane, 1/m^2.
Eigen::Matrix3d inverse_within_plane(const Eigen::Matrix3d& scatter, const Eigen::Vector3d& normal) {
  Eigen::Matrix<double, 3, 2> axes;
  axes.col(0) = normal.unitOrthogonal();
  axes.col(1) = normal.cross(axes.col(0));
  const Eigen::Matrix2d within = axes.transpose() * scatter * axes;
  return axes * within.inverse() * axes.transpose();
}

}  // namespace

ConfigFields fields(PlaneRule& rule) {
  return {
      {"min_points", &rule.min_points, kParameters + 1.0, 1e4, "", "fewer points in a cell make no plane"},
      {"max_flatness", &rule.max_flatness, 0.0, 1.0, "",
       "largest smallest-over-middle eigenvalue of the scatter of a plane's points"},
      {"min_width", &rule.min_width, 0.0, 1.0, "",
       "smallest spread of a plane's points in its narrower direction, over the edge of the cell"},
  };
}

std::optional<Plane> fit_plane(const Moments& moments, const Eigen::Vector3d& origin, double edge_m,
                               const PlaneRule& rule, const RangeNoise& noise) {
  if (moments.weight < rule.min_points) {
    return std::nullopt;
  }
  const Eigen::Vector3d mean = moments.first / moments.weight;
  const Eigen::Vector3d line_of_sight = (origin + mean - noise.position).normalized();
  const Eigen::Matrix3d scatter =
      scatter_around(mean, moments) - noise.variance * line_of_sight * line_of_sight.transpose();
  // In closed form: its errors are a billionth of the largest eigenvalue, and a plane is told by a hundredth.
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(scatter);
  const Eigen::Vector3d& values = eigen.eigenvalues();
  const double min_width = rule.min_width * edge_m;
  if (!(values[1] > min_width * min_width) || values[0] > rule.max_flatness * values[1]) {
    return std::nullopt;
  }
  Plane plane;
  plane.mean = origin + mean;
  plane.normal = eigen.eigenvectors().col(0);
  plane.tangential = inverse_within_plane(scatter, plane.normal);
  const double across = plane.normal.dot(line_of_sight);
  const double scattered = values[0] + noise.variance * across * across;  // n^T S n
  plane.variance = std::max(scattered, 0.0) * moments.weight / (moments.weight - kParameters);
  plane.points = moments.weight;
  plane.phase = moments.phase / moments.weight;
  plane.scan = moments.scan / moments.weight;
  return plane;
}

}  // namespace dynamic_icp::mapping
