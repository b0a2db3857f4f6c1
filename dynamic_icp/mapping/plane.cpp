// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/mapping/plane.hpp"

#include <algorithm>

#include <Eigen/Eigenvalues>

namespace dynamic_icp::mapping {
namespace {

// A plane has three parameters: that many residuals are lost to it.
constexpr double kParameters = 3.0;

}  // namespace

ConfigFields fields(PlaneRule& rule) {
  return {
      {"min_points", &rule.min_points, kParameters + 1.0, 1e4, "", "fewer points in a cell make no plane"},
      {"max_flatness", &rule.max_flatness, 0.0, 1.0, "",
       "largest smallest-over-middle eigenvalue of the scatter of a plane's points"},
      {"min_width", &rule.min_width, 0.0, 1.0, "",
       "least spread of a plane's points in its narrower direction, over the edge of the cell"},
  };
}

void Moments::add(const Eigen::Vector3d& point) {
  weight += 1.0;
  first += point;
  for (int column = 0; column < 3; ++column) {
    for (int row = column; row < 3; ++row) {
      second(row, column) += point[row] * point[column];
    }
  }
}

void Moments::scale(double factor) {
  weight *= factor;
  first *= factor;
  second *= factor;
}

std::optional<Plane> fit_plane(const Moments& moments, const Eigen::Vector3d& origin, double edge_m,
                               const PlaneRule& rule) {
  if (moments.weight < rule.min_points) {
    return std::nullopt;
  }
  const Eigen::Vector3d mean = moments.first / moments.weight;
  Eigen::Matrix3d scatter = moments.second.selfadjointView<Eigen::Lower>();
  scatter = scatter / moments.weight - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
  const Eigen::Vector3d& values = eigen.eigenvalues();
  const double least_width = rule.min_width * edge_m;
  if (!(values[1] > least_width * least_width) || values[0] > rule.max_flatness * values[1]) {
    return std::nullopt;
  }
  Plane plane;
  plane.mean = origin + mean;
  plane.normal = eigen.eigenvectors().col(0);
  for (int k = 1; k < 3; ++k) {
    plane.tangential += eigen.eigenvectors().col(k) * eigen.eigenvectors().col(k).transpose() / values[k];
  }
  plane.variance = std::max(values[0], 0.0) * moments.weight / (moments.weight - kParameters);
  plane.points = moments.weight;
  return plane;
}

}  // namespace dynamic_icp::mapping
