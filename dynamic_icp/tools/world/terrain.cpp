// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/terrain.hpp"

#include <cmath>
#include <numbers>

namespace dynamic_icp::world {

using Eigen::Vector2d;
using std::numbers::pi;

Terrain::Terrain(double roughness, const RandomSource& random) {
  constexpr int kWaves = 7;
  for (int i = 0; i < kWaves; ++i) {
    const RandomSource own = random.fork(static_cast<std::uint64_t>(i));
    const double length = 45.0 * std::pow(11.0 / 45.0, i / (kWaves - 1.0)) * own.uniform(0, 0.85, 1.15);
    const double direction = own.uniform(1, 0.0, 2.0 * pi);
    const double amplitude = 0.0075 * roughness * length;
    const Vector2d k = 2.0 * pi / length * Vector2d(std::cos(direction), std::sin(direction));
    waves_.push_back({amplitude, k, own.uniform(2, 0.0, 2.0 * pi)});
  }
}

double Terrain::height_m(const Vector2d& position) const {
  double height = 0.0;
  for (const Wave& wave : waves_) {
    height += wave.amplitude * std::sin(wave.k.dot(position) + wave.phase);
  }
  return height;
}

Sway Terrain::sway(const PlanarState& planar) const {
  Vector2d gradient = Vector2d::Zero();
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
  for (const Wave& wave : waves_) {
    const double angle = wave.k.dot(planar.position) + wave.phase;
    gradient += wave.amplitude * std::cos(angle) * wave.k;
    hessian -= wave.amplitude * std::sin(angle) * wave.k * wave.k.transpose();
  }
  const Vector2d forward(std::cos(planar.heading_rad), std::sin(planar.heading_rad));
  const Vector2d left(-forward.y(), forward.x());
  // The axes turn as the vehicle turns: d forward / dt = yaw rate * left, d left / dt = -yaw rate * forward.
  const Vector2d gradient_rate = hessian * planar.velocity;
  const double slope_forward = gradient.dot(forward);
  const double slope_left = gradient.dot(left);
  const double slope_forward_rate = gradient_rate.dot(forward) + planar.yaw_rate_rps * slope_left;
  const double slope_left_rate = gradient_rate.dot(left) - planar.yaw_rate_rps * slope_forward;
  Sway sway;
  sway.heave_m = height_m(planar.position);
  sway.heave_mps = gradient.dot(planar.velocity);
  sway.pitch_rad = -std::atan(slope_forward);
  sway.pitch_rps = -slope_forward_rate / (1.0 + slope_forward * slope_forward);
  sway.roll_rad = std::atan(slope_left);
  sway.roll_rps = slope_left_rate / (1.0 + slope_left * slope_left);
  return sway;
}

TriangleMesh Terrain::mesh(const Vector2d& low, const Vector2d& high, double cell_m, double grain_m,
                           const RandomSource& random) const {
  const auto columns = static_cast<std::size_t>(std::ceil((high.x() - low.x()) / cell_m)) + 1;
  const auto rows = static_cast<std::size_t>(std::ceil((high.y() - low.y()) / cell_m)) + 1;
  std::vector<Eigen::Vector3d> points;
  points.reserve(columns * rows);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const Vector2d position = low + cell_m * Vector2d(static_cast<double>(column), static_cast<double>(row));
      const double grain = random.uniform(row * columns + column, -grain_m, grain_m);
      points.emplace_back(position.x(), position.y(), height_m(position) + grain);
    }
  }
  return make_sheet(points, columns);
}

}  // namespace dynamic_icp::world
